// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/lesson.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

struct StepName {
  const char* step;
  const char* words;
};
constexpr std::array<StepName, 11> kSteps{{
    {"ask:side", msgid("asked which side")},
    {"ask:allergy", msgid("asked about allergies")},
    {"ask:consent", msgid("asked for consent")},
    {"ask:anticoagulation", msgid("asked about blood thinners")},
    {"ask:infection", msgid("asked about fever and infections")},
    {"auto:doppler", msgid("looked for vessels (colour)")},
    {"auto:entry", msgid("needle in")},
    {"auto:tip_seen", msgid("tip seen")},
    {"auto:placed", msgid("tip in place")},
    {"auto:injected", msgid("liquid injected")},
    {"auto:withdrawn", msgid("needle out again")},
}};

constexpr double kAlmostAll = 0.9;  // of what is to be given
constexpr int kToldAtOnce = 3;      // the highest level whose truth is told while it is done

double value_of(const Scenario& scenario, const std::string& name) {
  for (const Aid& aid : scenario.aids)
    if (aid.name == name) return aid.value;
  return 0;
}

/// m from the target within which the tip is in place: as the mark asks, else 2 mm.
double reach_of(const Scenario& scenario) {
  for (const Mark& mark : scenario.pass)
    if (mark.metric == "distance_mm") return mark.bound * kMillimetre;
  return 2e-3;
}

}  // namespace

TrainLesson::TrainLesson(Scenario scenario, std::shared_ptr<const Scene> scene,
                         const SessionParams& params, std::set<std::string> asked,
                         Language language)
    : scenario_(std::move(scenario)),
      scene_(std::move(scene)),
      period_(1 / params.haptic_rate),
      finder_(params.transducer, params.image.depth, params.needle_shape, params.image.look),
      search_(scene_->joint(), scenario_.find, params.transducer, params.image.depth,
              StructureSearch::kTold),
      done_(std::move(asked)),
      language_(language) {
  if (auto options = make_meter_options(scenario_, scene_->joint(), params))
    goals_ = std::move(options->goals);
  say_calmly();
}

void TrainLesson::say_calmly() {
  hurts_ = false;
  patient_ = translate(language_, scenario_.gel ? msgid("A gel block: it says nothing.")
                                                : msgid("The patient keeps still."));
}

void TrainLesson::say(const char* what, double time, bool hurts) {
  if (scenario_.gel) return;
  patient_ = translate(language_, what);
  hurts_ = hurts;
  said_at_ = time;
}

/// Which steps are done by now.
void TrainLesson::follow(const LessonView& view) {
  const bool inside = view.needle.inside;
  if (!inside && view.doppler && done_.count("auto:entry") == 0) done_.insert("auto:doppler");
  if (inside) done_.insert("auto:entry");
  const Pose X_JN = to_pose(view.now.X_JN);
  TipSight sight = finder_.look(*scene_, to_pose(view.now.X_JP), X_JN);
  if (shown_db_) sight.shown_db = shown_db_();
  if (inside && sight.seen()) done_.insert("auto:tip_seen");
  beam_on_tip_ = sight.loss != SightLoss::off_plane;
  if (inside && (X_JN.translation() - scenario_.target.point).norm() <= reach_of(scenario_))
    done_.insert("auto:placed");
  if (inside && !scenario_.target.structure.empty() &&
      scene_->joint().regions[view.needle.region].name == scenario_.target.structure)
    done_.insert("auto:placed");
  if (scenario_.syringe.volume > 0 &&
      view.now.feedback.plunger.given >= kAlmostAll * scenario_.syringe.volume)
    done_.insert("auto:injected");
  if (!inside && done_.count("auto:placed") != 0) done_.insert("auto:withdrawn");
}

/// What the patient says; the newest goes first, and is forgotten after a while.
void TrainLesson::listen(const LessonView& view, double time) {
  constexpr double kHeard = 4;  // s; assumed
  const bool inside = view.needle.inside;
  const RegionId region = view.needle.region;
  const auto zone =
      std::find_if(scenario_.avoid.begin(), scenario_.avoid.end(), [&](const ScenarioAvoid& a) {
        return inside && a.structure == scene_->joint().regions[region].name;
      });
  const bool in_zone = zone != scenario_.avoid.end();
  const bool late = time > scenario_.time_limit;
  if (time - said_at_ > kHeard) say_calmly();
  if (late && !was_late_) say(msgid("Will it be over soon?"), time, false);
  if (inside && !was_inside_) say(msgid("I feel the prick."), time, false);
  if (in_zone && !was_in_zone_)
    say(zone->structure.find("nerve") != std::string::npos ? msgid("It shoots down my arm!")
                                                           : msgid("That hurts!"),
        time, true);
  if (view.needle.on_bone && !was_on_bone_) say(msgid("Ow! That is the bone."), time, true);
  was_inside_ = inside;
  was_on_bone_ = view.needle.on_bone;
  was_in_zone_ = in_zone;
  was_late_ = late;
}

Lesson TrainLesson::lead(const LessonView& view) {
  if (first_tick_ == 0) first_tick_ = view.now.input.tick;
  const double time = period_ * static_cast<double>(view.now.input.tick - first_tick_);
  if (view.now.input.tick != 0) {
    if (view.now.input.device.has_probe != 0) search_.look(*scene_, time, to_pose(view.now.X_JP));
    follow(view);
    listen(view, time);
  }
  Lesson lesson;
  lesson.title = title_words(language_, scenario_);
  lesson.goal = goal_words(scenario_, language_);
  lesson.late = time > scenario_.time_limit;
  lesson.clock = fill(translate(language_, "{} s of {}"),
                      {number(language_, time, 0), number(language_, scenario_.time_limit, 0)});
  lesson.patient = patient_;
  lesson.patient_hurts = hurts_;
  lesson.over = time > longest();
  lesson.beam_on_tip = beam_on_tip_;
  for (const std::string& step : scenario_.steps) {
    const bool of_truth =
        step == "auto:tip_seen" || step == "auto:placed" || step == "auto:withdrawn";
    lesson.steps.push_back({step_words(language_, step), done_.count(step) != 0,
                            !of_truth || scenario_.level <= kToldAtOnce});
  }
  if (scenario_.find.empty() && (scenario_.level <= kToldAtOnce || scenario_.aided()))
    lesson.next = next_words(view);
  if (!scenario_.find.empty()) lead_search(time, lesson);
  return lesson;
}

/// From where the needle is in place to the end: what is next. Empty: the guide says it.
std::string TrainLesson::next_words(const LessonView& view) const {
  const auto done = [this](const char* step) {
    return done_.count(step) != 0;
  };
  const auto key = [this](Action action) {
    return keys_.said_key(action, language_);
  };
  if (led_ == LedHand::needle)
    return fill(translate(language_, "{} takes the probe: keep the needle's tip in the picture"),
                {key(Action::take_probe)});
  if (!view.needle.inside)
    return done("auto:withdrawn")
               ? fill(translate(language_, "The needle is out: {} ends it"), {key(Action::finish)})
               : "";
  if (!done("auto:placed")) return "";
  const double volume = scenario_.syringe.volume;
  const double given = view.now.feedback.plunger.given;
  if (volume > 0 && given <= 0)
    return fill(translate(language_,
                          "In place: {} puts the thumb on the plunger; draw back for 3 s, then "
                          "inject slowly"),
                {key(Action::take_plunger)});
  if (volume > 0 && !done("auto:injected"))
    return fill(translate(language_, "Inject on, the tip in sight: {} of {} ml"),
                {number(language_, given / kCubicCentimetre, 1),
                 number(language_, volume / kCubicCentimetre, 1)});
  return fill(translate(language_, volume > 0 ? msgid("Injected: {} pulls the needle out")
                                              : msgid("In place: {} pulls the needle out")),
              {key(Action::pull)});
}

/// What is to be shown now, and what was.
void TrainLesson::lead_search(double time, Lesson& lesson) const {
  constexpr double kRead = 1.5;  // s that the last word stands
  for (const Sought& one : search_.sought())
    lesson.steps.push_back({clinical_name(language_, one.name), one.found >= 0, true});
  if (search_.done()) {
    lesson.goal = translate(language_, "All structures were shown");
    lesson.over = lesson.over || time > search_.sought().back().found + kRead;
    return;
  }
  const Sought& now = search_.sought()[search_.found()];
  lesson.goal = fill(translate(language_, "Show this in the middle of the picture: {}"),
                     {clinical_name(language_, now.name)});
}

LessonOptions TrainLesson::options() {
  LessonOptions options;
  options.lead = [this](const LessonView& view) {
    return lead(view);
  };
  options.needle = scenario_.find.empty();
  LessonAids& aids = options.aids;
  aids.needle = value_of(scenario_, "needle_overlay");
  aids.tip = value_of(scenario_, "tip_marker");
  aids.target = value_of(scenario_, "target_glow");
  aids.labels = value_of(scenario_, "labels");
  aids.plane = value_of(scenario_, "plane_beam");
  if (scenario_.find.empty()) aids.target_J = scenario_.target.point;
  return options;
}

std::string goal_words(const Scenario& scenario, Language language) {
  if (!scenario.find.empty()) {
    std::string names;
    for (const std::string& name : scenario.find)
      names += (names.empty() ? "" : ", ") + clinical_name(language, name);
    return fill(translate(language,
                          "Show, one after another: {}. Bring each to the middle of the picture "
                          "and hold it there for 2 s"),
                {names});
  }
  const Vec3 target_P = scenario.X_JP.inverse() * scenario.target.point;
  if (scenario.target.structure.empty()) {
    constexpr double kMiddle = 0.5e-3;  // m
    const double beside = target_P.x();
    const std::string where =
        std::abs(beside) < kMiddle
            ? translate(language, " in the picture's middle")
            : fill(translate(language, beside < 0
                                           ? msgid(", {} mm to the left of the picture's middle")
                                           : msgid(", {} mm to the right of the picture's middle")),
                   {number(language, std::abs(beside) / kMillimetre, 0)});
    return fill(translate(language, "Bring the tip to the point {} mm deep{}"),
                {number(language, target_P.z() / kMillimetre, 0), where});
  }
  return fill(translate(language, "Bring the tip into the {}"),
              {clinical_name(language, scenario.target.structure)});
}

std::string step_words(Language language, const std::string& step) {
  for (const StepName& known : kSteps)
    if (step == known.step) return translate(language, known.words);
  return step;
}

HandTarget first_hands(const Scenario& scenario) {
  constexpr double kAbove = 15e-3;  // m of the tip from the entry
  constexpr int kAimed = 1;         // the highest level that begins in the plane
  const Vec3 direction = scenario.find.empty()
                             ? (scenario.target.point - scenario.entry.centre).normalized()
                             : Vec3(scenario.X_JP.linear().col(2));
  Vec3 tip = scenario.entry.centre - kAbove * direction;
  if (scenario.level > kAimed) {
    constexpr double kBeside = 6e-3;  // m
    constexpr double kBack = 4e-3;    // m
    tip += kBeside * scenario.X_JP.linear().col(1) - kBack * direction;
  }
  HandTarget target;
  target.has_needle = scenario.find.empty() ? 1 : 0;
  target.X_WN = to_plain(make_pose(tip, direction, Vec3::Zero()));
  target.X_WP = to_plain(scenario.X_JP);
  return target;
}

}  // namespace artus
