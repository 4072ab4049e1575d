// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "artus/detail/session/hand_device.h"
#include "artus/detail/trainer/led_hands.h"
#include "artus/detail/training/player.h"
#include "artus/detail/viewer/input/key_map.h"
#include "artus/detail/viewer/panels/lesson.h"
#include "artus/detail/viewer/words/translation.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Follows an attempt for the window: steps, clock, and what the patient says. What only the truth
/// tells is shown up to level 3; from level 4 on people hear of it afterwards.
class TrainLesson {
 public:
  /// `asked`: steps that were answered before.
  TrainLesson(Scenario scenario, std::shared_ptr<const Scene> scene, const SessionParams& params,
              std::set<std::string> asked, Language language);

  /// Who knows by how many dB the tip stands out in the last picture, LiveAttempt::shown_db;
  /// without it geometry says whether the tip is seen.
  void look_at_pictures(std::function<std::optional<double>()> shown_db) {
    shown_db_ = std::move(shown_db);
  }

  /// The keys that what is next names.
  void name_keys(const KeyMap& keys) { keys_ = keys; }
  /// A hand goes its own way: what is next is said of the other.
  void leave_hand(LedHand led) { led_ = led; }

  [[nodiscard]] Lesson lead(const LessonView& view);
  [[nodiscard]] LessonOptions options();
  /// s after which the window ends by itself.
  [[nodiscard]] double longest() const noexcept { return 2 * scenario_.time_limit + 50; }

 private:
  void follow(const LessonView& view);
  [[nodiscard]] std::string next_words(const LessonView& view) const;
  void lead_search(double time, Lesson& lesson) const;
  void listen(const LessonView& view, double time);
  void say(const char* what, double time, bool hurts);
  void say_calmly();

  Scenario scenario_;
  std::shared_ptr<const Scene> scene_;
  double period_;  // s of a tick
  TipSightFinder finder_;
  StructureSearch search_;
  Goals goals_;
  KeyMap keys_;
  LedHand led_ = LedHand::none;
  std::function<std::optional<double>()> shown_db_;
  std::set<std::string> done_;
  Language language_;
  std::uint64_t first_tick_ = 0;
  bool beam_on_tip_ = true;
  bool was_on_bone_ = false;
  bool was_in_zone_ = false;
  bool was_inside_ = false;
  bool was_late_ = false;
  std::string patient_;
  bool hurts_ = false;
  double said_at_ = -1e9;  // s
};

/// What a task's window says it is for: the target in words.
[[nodiscard]] std::string goal_words(const Scenario& scenario, Language language);

/// A step of a scenario in words.
[[nodiscard]] std::string step_words(Language language, const std::string& step);

/// Where both hands stand at first: the probe at the scenario's view; the needle over its entry and
/// along the planned way, from level 2 on 6 mm beside the plane and 4 mm back, so that who does not
/// look misses it (assumed).
[[nodiscard]] HandTarget first_hands(const Scenario& scenario);

}  // namespace artus
