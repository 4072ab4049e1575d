// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/learn.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/trainer/lesson.h"
#include "artus/detail/training/player.h"
#include "artus/detail/viewer/words/anatomy_names.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

struct Told {
  const char* name;
  const char* words;
};

/// How tissues look, as textbooks of musculoskeletal ultrasound say.
constexpr std::array<Told, 16> kLooks{{
    {"skin", msgid("the bright line under the face")},
    {"fat", msgid("dark lobules between bright strands")},
    {"fascia", msgid("a bright line between muscles")},
    {"muscle", msgid("dark, with bright strands that run along it")},
    {"tendon", msgid("bright and finely striped where the beam meets it squarely, dark where it "
                     "does not")},
    {"ligament", msgid("a bright, striped band from bone to bone")},
    {"capsule", msgid("a bright band close to the joint")},
    {"bursa", msgid("a thin dark line between two bright ones; liquid opens it")},
    {"synovial_fluid", msgid("black, and brighter behind")},
    {"fluid", msgid("black, and brighter behind")},
    {"cartilage", msgid("a dark even layer along the bone")},
    {"labrum", msgid("a bright wedge at the rim of the socket")},
    {"bone", msgid("a very bright line with black behind it")},
    {"nerve", msgid("a bundle of dark dots in bright, like a honeycomb")},
    {"artery", msgid("black and round; it beats, and colour shows its flow")},
    {"calcification", msgid("bright, sometimes with a shadow behind")},
}};

/// Why a tissue must not be entered.
constexpr std::array<Told, 8> kWhy{{
    {"cartilage", msgid("a needle scratches it, and it does not heal")},
    {"tendon", msgid("what is given into it weakens it: it can tear")},
    {"ligament", msgid("what is given into it weakens it: it can tear")},
    {"labrum", msgid("a hole in it does not heal, and it holds the joint")},
    {"artery", msgid("it bleeds, and what is given goes with the blood")},
    {"vein", msgid("it bleeds, and what is given goes with the blood")},
    {"nerve", msgid("pain and weakness that can stay")},
    {"bone", msgid("its skin hurts, and the tip bends")},
}};

/// How the patient sits or lies, by the procedure.
constexpr std::array<Told, 16> kPostures{{
    {"", msgid("The block lies before you, the screen behind it.")},
    {"sasd_lateral", msgid("The patient sits, the arm hanging. Stand beside the shoulder.")},
    {"sasd_anterior",
     msgid("The patient sits, the hand on the hip and the elbow back. Stand in front of the "
           "shoulder.")},
    {"gh_posterior",
     msgid("The patient sits, the hand on the other shoulder. Stand behind the shoulder.")},
    {"lhb_sheath",
     msgid("The patient lies on the back, the palm up. Sit at the side of the shoulder.")},
    {"gh_interval",
     msgid("The patient lies on the back, the arm turned out. Sit at the side of the shoulder.")},
    {"ac", msgid("The patient sits, the arm hanging. Stand beside and a little behind.")},
    {"gh_distension",
     msgid("The patient lies on the other side, the hand on the other shoulder. Stand behind.")},
    {"ssn_notch",
     msgid("The patient sits, leaning forward, the hand on the other shoulder. Stand behind.")},
    {"barbotage",
     msgid("The patient lies half on the other side, the hand on the hip. Stand beside the "
           "shoulder.")},
    {"common_extensor",
     msgid("The patient sits, the elbow bent on the table, the thumb up. Sit at the side of the "
           "elbow.")},
    {"elbow_posterior",
     msgid("The patient lies on the back, the elbow bent across the chest. Stand behind the "
           "elbow.")},
    {"carpal_tunnel",
     msgid("The patient sits, the palm up on the table, the wrist a little bent back. Sit at the "
           "side of the little finger.")},
    {"first_compartment",
     msgid("The patient sits, the hand on its edge on the table, the thumb up. Sit before the "
           "hand.")},
    {"tibiotalar",
     msgid("The patient lies on the back, the knee bent, the sole flat. Stand at the foot.")},
    {"retrocalcaneal",
     msgid("The patient lies face down, the foot over the edge. Sit behind the heel.")},
}};

template <std::size_t N>
const char* told_of(const std::array<Told, N>& all, const std::string& name) {
  for (const Told& one : all)
    if (name == one.name) return one.words;
  return nullptr;
}

std::string tissue_of(const Scene& scene, RegionId region) {
  return scene.joint().tissue_of(region).name;
}

std::string millimetres(Language language, double length) {
  return number(language, length / kMillimetre, 0);
}

/// What lies under the middle of the face, from the skin down.
std::vector<PageLine> looks_of(const Scenario& scenario, const Scene& scene, Language language) {
  std::vector<PageLine> lines{
      {translate(language, "From the skin down, in the middle:"), Tone::heading}};
  std::array<TissueInterval, 64> layers;
  const Vec3 face = scenario.X_JP.translation();
  const Vec3 down = scenario.X_JP.linear().col(2);
  const QueryCount count = scene.find_intervals({face, face + scenario.depth * down}, layers);
  const std::span<const TissueInterval> line(layers.data(), count.size);
  std::set<std::string> said;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k].region < kFirstRegion) continue;
    const std::string name = layer_name(language, scene.joint(), line, k);
    if (!said.insert(name).second) continue;
    const char* look = told_of(kLooks, tissue_of(scene, line[k].region));
    const std::string from = millimetres(language, line[k].entry);
    lines.push_back({look == nullptr ? fill(translate(language, "{} mm: {}"), {from, name})
                                     : fill(translate(language, "{} mm: {}: {}"),
                                            {from, name, translate(language, look)})});
  }
  return lines;
}

std::vector<PageLine> never_of(const Scenario& scenario, const Scene& scene, Language language) {
  std::vector<PageLine> lines;
  for (const ScenarioAvoid& avoid : scenario.avoid) {
    const auto& regions = scene.joint().regions;
    const auto found = std::find_if(regions.begin(), regions.end(),
                                    [&](const auto& r) { return r.name == avoid.structure; });
    const char* why = nullptr;
    if (found != regions.end())
      why = told_of(kWhy, tissue_of(scene, static_cast<RegionId>(found - regions.begin())));
    const std::string name = clinical_name(language, avoid.structure);
    lines.push_back(
        {fill(translate(language, avoid.fatal ? msgid("Never: {}") : msgid("Spare: {}")), {name}),
         avoid.fatal ? Tone::bad : Tone::heading});
    if (why != nullptr) lines.push_back({translate(language, why)});
  }
  if (lines.empty()) lines.push_back({translate(language, "Nothing here can be harmed.")});
  lines.push_back(
      {translate(language, "See the tip before you go on: what is not seen is not spared."),
       Tone::dim});
  return lines;
}

std::vector<PageLine> stand_of(const Scenario& scenario, Language language) {
  std::vector<PageLine> lines;
  if (const char* posture = told_of(kPostures, scenario.procedure))
    lines.push_back({translate(language, posture)});
  lines.push_back({translate(language,
                             "Needle, probe and screen lie in one line of sight: you look over the "
                             "probe at the picture.")});
  const Vec3 entry = scenario.X_JP.inverse() * scenario.entry.centre;
  const Vec3 target = scenario.X_JP.inverse() * scenario.target.point;
  const Vec3 way = (target - entry).normalized();
  lines.push_back(
      {fill(translate(language,
                      "The needle goes in {} mm from the probe's middle, at {} degrees to "
                      "its face; the target is {} mm deep."),
            {millimetres(language, std::hypot(entry.x(), entry.y())),
             number(language, std::asin(std::min(1.0, std::abs(way.z()))) / kDegree, 0),
             millimetres(language, target.z())})});
  if (scenario.entry.plane == "in")
    lines.push_back({translate(
        language, entry.x() < 0
                      ? msgid("The needle goes in at the end of the probe that has the mark")
                      : msgid("The needle goes in at the end of the probe without the mark"))});
  lines.push_back({translate(language, "Rest the probe hand on the patient."), Tone::dim});
  return lines;
}

/// The picture with the borders of its regions, `share` of their full brightness.
std::shared_ptr<const PagePicture> with_borders(const Frame& frame, const LabelImage& labels,
                                                const std::set<RegionId>& whole, double share) {
  constexpr int kDotted = 4;  // pixels from one dot to the next
  PagePicture picture{frame.width, frame.height, frame.image};
  const int width = std::min(frame.width, labels.width);
  for (int y = 0; y + 1 < std::min(frame.height, labels.height); ++y) {
    for (int x = 0; x + 1 < width; ++x) {
      const auto at = [&](int i, int j) {
        return labels.regions[static_cast<std::size_t>(j) * static_cast<std::size_t>(labels.width) +
                              static_cast<std::size_t>(i)];
      };
      const RegionId here = at(x, y);
      const RegionId right = at(x + 1, y);
      const RegionId below = at(x, y + 1);
      if (here == right && here == below) continue;
      const bool marked = whole.count(here) + whole.count(right) + whole.count(below) > 0;
      if (!marked && (x + y) % kDotted != 0) continue;
      std::uint8_t& grey =
          picture.grey[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                       static_cast<std::size_t>(x)];
      grey = static_cast<std::uint8_t>(std::lround(grey + share * (255 - grey)));
    }
  }
  return std::make_shared<const PagePicture>(std::move(picture));
}

std::vector<std::shared_ptr<const PagePicture>> fading_of(
    const Scenario& scenario, const std::shared_ptr<const Scene>& scene) {
  constexpr int kSteps = 6;
  std::vector<std::shared_ptr<const PagePicture>> fading;
  const auto params = make_session_params(scenario);
  if (!params) return fading;
  Renderer renderer(scene, params->transducer, params->image);
  const Frame frame = renderer.render(scenario.X_JP);
  const LabelImage labels = render_shown_labels(renderer, scenario.X_JP);
  std::set<RegionId> whole;
  const auto& regions = scene->joint().regions;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const bool spared =
        std::any_of(scenario.avoid.begin(), scenario.avoid.end(),
                    [&](const ScenarioAvoid& avoid) { return avoid.structure == regions[i].name; });
    if (spared || regions[i].name == scenario.target.structure)
      whole.insert(static_cast<RegionId>(i));
  }
  for (int i = 0; i <= kSteps; ++i)
    fading.push_back(with_borders(frame, labels, whole, static_cast<double>(i) / kSteps));
  return fading;
}

struct NamedChoice {
  const char* name;
  const char* about;
};
constexpr std::array<NamedChoice, 7> kChoices{{
    {msgid("1. What it looks like"), ""},
    {msgid("2. What must not be entered, and why"), ""},
    {msgid("3. Where to stand, and where the needle goes in"), ""},
    {msgid("4. Watch the expert's hands"),
     msgid("The simulated expert's run, with both hands, the picture and the forces.")},
    {msgid("5. You: the probe alone"),
     msgid("The needle goes the expert's way, again and again. Keep its tip in the picture.")},
    {msgid("6. You: the needle alone"),
     msgid("The probe goes the expert's way. Bring the tip to the target in its picture.")},
    {msgid("7. Both hands: the task"), msgid("The task itself, with its aids or without.")},
}};

}  // namespace

LearnContent make_learn_content(const Scenario& scenario, const std::shared_ptr<const Scene>& scene,
                                Language language) {
  return {looks_of(scenario, *scene, language), never_of(scenario, *scene, language),
          stand_of(scenario, language), fading_of(scenario, scene)};
}

Page make_learn_page(const Scenario& scenario, const LearnContent& content, LearnChoice at,
                     Language language) {
  Page page;
  page.name = "learn";
  page.title = fill(translate(language, "Learn: {}"), {title_words(language, scenario)});
  page.may_back = true;
  page.at = static_cast<std::size_t>(at);
  page.lines = {{goal_words(scenario, language)},
                {translate(language, "Nothing here is judged."), Tone::dim}};
  const std::array<const std::vector<PageLine>*, 3> told{&content.looks, &content.never,
                                                         &content.stand};
  for (std::size_t i = 0; i < kChoices.size(); ++i) {
    PageChoice choice{translate(language, kChoices[i].name), "", Tone::plain, {}, nullptr};
    if (i < told.size())
      choice.about = *told[i];
    else
      choice.about = {{translate(language, kChoices[i].about)}};
    if (i + 1 == kChoices.size()) choice.tone = Tone::good;
    page.choices.push_back(std::move(choice));
  }
  page.refresh = [&content, begin = std::chrono::steady_clock::now()](Page& shown) {
    constexpr double kFade = 2;  // s from plain to full
    if (content.fading.empty() || shown.at > static_cast<std::size_t>(LearnChoice::stand)) return;
    const double time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double share = 0.5 - 0.5 * std::cos(time / kFade * 180 * kDegree);
    const auto last = static_cast<double>(content.fading.size() - 1);
    shown.choices[shown.at].picture =
        content.fading[static_cast<std::size_t>(std::lround(share * last))];
  };
  return page;
}

std::optional<LedHand> led_in(LearnChoice choice) noexcept {
  if (choice == LearnChoice::probe_alone) return LedHand::needle;
  if (choice == LearnChoice::needle_alone) return LedHand::probe;
  return std::nullopt;
}

Scenario for_one_hand(Scenario scenario) {
  std::erase_if(scenario.aids, [](const Aid& aid) { return aid.name == "tip_marker"; });
  scenario.aids.push_back({"tip_marker", 1});
  return scenario;
}

}  // namespace artus
