// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/review.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/reports/feedback_words.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/session/liquid_at_tip.h"
#include "artus/detail/viewer/words/anatomy_names.h"
#include "artus/session/replay.h"

namespace artus {
namespace {

/// By how much the tip stood out in the pictures of a recording, by their samples' time.
class ShownTips {
 public:
  explicit ShownTips(const Recording& recording) {
    for (const FrameRecord& frame : recording.frames)
      if (frame.input.has_needle != 0 && frame.digest != 0)
        pictures_.emplace_back(frame.input.sample_time_ns, static_cast<double>(frame.tip_contrast));
  }

  /// dB in the last picture before a moment; empty where there was none within a quarter second.
  [[nodiscard]] std::optional<double> at(std::int64_t time_ns) const {
    constexpr std::int64_t kLately = 250'000'000;  // ns
    const auto after = std::upper_bound(
        pictures_.begin(), pictures_.end(), time_ns,
        [](std::int64_t time, const auto& picture) { return time < picture.first; });
    if (after == pictures_.begin() || time_ns - std::prev(after)->first > kLately)
      return std::nullopt;
    const double contrast = std::prev(after)->second;
    return std::isnan(contrast) ? kNotShown : contrast;
  }

 private:
  std::vector<std::pair<std::int64_t, double>> pictures_;
};

/// What the truth says of the tip: where it is, and why it is seen or not. `shown`: dB by which it
/// stood out in the picture.
std::string why_of(const TipSightFinder& finder, const Scene& scene, const HapticSnapshot& state,
                   std::optional<double> shown, Language language) {
  if (state.input.device.has_needle == 0) return "";
  if (state.inserted == 0) return translate(language, "The needle is not in the body here");
  TipSight sight = finder.look(scene, to_pose(state.X_JP), to_pose(state.X_JN));
  sight.shown_db = shown;
  const auto mm = [&](double length) {
    return number(language, length / kMillimetre, 1);
  };
  const auto liquid = liquid_at_tip(state);
  const auto& region =
      scene.joint().regions[liquid.value_or(static_cast<RegionId>(state.feedback.region))];
  const std::string name = clinical_name(language, region.name);
  std::string where = fill(
      translate(language,
                "The tip is in: {}. It lies {} mm beside the picture's plane, whose slice is {} mm "
                "thick to either side there"),
      {liquid ? fill(translate(language, "liquid in: {}"), {name}) : name,
       mm(std::abs(sight.offset)), mm(sight.half_width)});
  if (sight.seen()) return where + ". " + translate(language, "It can be seen.");
  switch (sight.loss) {
    case SightLoss::none:
      return where + ". " +
             translate(language, "It cannot be seen: what lies around it is as bright.");
    case SightLoss::no_contact:
      return where + ". " +
             translate(language, "It cannot be seen: the probe does not touch there.");
    case SightLoss::off_plane:
      return where + ". " + translate(language, "It cannot be seen: the beam passes beside it.");
    case SightLoss::off_sector:
      return where + ". " +
             translate(language, "It cannot be seen: it is beside or below the picture.");
    case SightLoss::shadow:
      return where + ". " +
             fill(translate(language, "It cannot be seen: it lies in the shadow of the {}."),
                  {clinical_name(language, scene.joint().regions[sight.shadow].name)});
    case SightLoss::angle:
      break;
  }
  return where + ". " +
         fill(translate(language,
                        "It cannot be seen: at {} degrees to the probe's face the echo is "
                        "reflected away ({} dB above muscle)."),
              {number(language, sight.face_angle / kDegree, 0),
               number(language, sight.contrast_db, 0)});
}

/// The first structure that was asked for and not shown is the review's target, with how far the
/// picture was from it; nothing where the block does not say where it is.
void show_missed(const Scenario& scenario, std::span<const Sought> sought, Language language,
                 Review& review) {
  const auto missed =
      std::find_if(sought.begin(), sought.end(), [](const Sought& one) { return one.found < 0; });
  if (missed == sought.end() || !scenario.gel) return;
  for (const Ball& ball : scenario.gel->balls) {
    if (ball.tissue != missed->name) continue;
    review.target_J = ball.centre;
    review.why = [name = clinical_name(language, ball.tissue), centre = ball.centre,
                  language](const HapticSnapshot& state) {
      const Vec3 p = to_pose(state.X_JP).inverse() * centre;
      return fill(translate(language,
                            "Not shown: {}. Its middle lies {} mm beside the picture's "
                            "plane and {} mm from the picture's middle."),
                  {name, number(language, std::abs(p.y()) / kMillimetre, 0),
                   number(language, std::abs(p.x()) / kMillimetre, 0)});
    };
    return;
  }
}

/// Where the picture's clock stands against the moments': the last that was there.
class Frames {
 public:
  explicit Frames(const Recording& recording) : recording_(recording) {}

  [[nodiscard]] FrameInput at(const HapticSnapshot& state) {
    const auto& frames = recording_.frames;
    while (next_ < frames.size() &&
           frames[next_].input.sample_time_ns <= state.input.device.time_ns)
      ++next_;
    if (next_ > 0) return frames[next_ - 1].input;
    return frame_input(state, controls_of(recording_.head.params), 1);
  }

 private:
  const Recording& recording_;
  std::size_t next_ = 0;
};

}  // namespace

Result<ReviewFilm> make_film(const Recording& recording,
                             const std::shared_ptr<const Scene>& scene) {
  constexpr double kRate = 50;  // Hz
  const double rate = recording.head.params.haptic_rate;
  const auto every = static_cast<std::uint64_t>(std::max(1.0, std::round(rate / kRate)));
  Recording ticks;
  ticks.head = recording.head;
  ticks.ticks = recording.ticks;
  ticks.packets = recording.packets;
  Frames frames(recording);
  ReviewFilm film;
  std::uint64_t n = 0;
  ReplayListener listener;
  listener.on_tick = [&](const HapticSnapshot& state) {
    if (n++ % every != 0) return;
    const double time =
        static_cast<double>(state.input.tick - recording.ticks.front().input.tick) / rate;
    film.moments.push_back({time, state, frames.at(state)});
  };
  const auto replayed = replay(ticks, scene, listener);
  ARTUS_TRY(replayed);
  return film;
}

Result<Review> make_run_review(const Scenario& scenario, const std::shared_ptr<const Scene>& scene,
                               const Recording& recording, Language language) {
  Review review;
  review.title = title_words(language, scenario);
  review.scene = scene;
  review.params = recording.head.params;
  if (scenario.find.empty()) review.target_J = scenario.target.point;
  review.in_plane = scenario.entry.plane == "in";
  auto film = make_film(recording, scene);
  ARTUS_TRY(film);
  review.film = std::move(*film);
  const TipSightFinder finder(review.params.transducer, review.params.image.depth,
                              review.params.needle_shape, review.params.image.look);
  const ShownTips tips(recording);
  review.why = [finder, tips, scene, language](const HapticSnapshot& state) {
    return why_of(finder, *scene, state, tips.at(state.input.device.time_ns), language);
  };
  return review;
}

Result<Review> make_review(const TrainTask& task, const TrainOutcome& outcome, Language language) {
  const PlayedAttempt& played = outcome.played;
  auto made = make_run_review(task.scenario, task.scene, played.recording, language);
  ARTUS_TRY(made);
  Review review = std::move(*made);
  review.outside = task.outside;
  show_missed(task.scenario, played.measures.sought, language, review);
  const auto expert = play(task.scenario, task.scene, expert_skill(), {});
  ARTUS_TRY(expert);
  auto beside = make_film(expert->recording, task.scene);
  ARTUS_TRY(beside);
  review.expert = std::move(*beside);
  const auto& ticks = played.recording.ticks;
  const double begin =
      ticks.empty() ? 0 : static_cast<double>(ticks.front().input.tick) / review.params.haptic_rate;
  for (const Fault& fault : outcome.feedback.faults)
    review.faults.push_back({fault.time - begin, feedback_words(language, fault.what),
                             feedback_words(language, fault.cause),
                             feedback_words(language, fault.mend)});
  return review;
}

}  // namespace artus
