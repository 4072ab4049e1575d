// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "artus/detail/simulation/records.h"
#include "artus/detail/viewer/input/hand_control.h"
#include "artus/detail/viewer/input/key_map.h"
#include "artus/detail/viewer/panels/needle_reading.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What the guide looks at.
struct GuideInput {
  Language language = Language::english;
  const KeyMap* keys = nullptr;
  bool has_hand = true;  ///< of mouse and keyboard
  bool welcome = false;  ///< nothing was chosen yet
  bool paused = false;
  bool frozen = false;  ///< the picture
  PeerState peer = PeerState::alive;
  std::string connect;  ///< how a device that was never there is connected
  GesturePhase phase = GesturePhase::exploring;
  Grab grab = Grab::nothing;
  bool probe_lifted = false;
  std::string target;  ///< the structure's name; empty: there is no goal
  RegionId target_region = kOutside;
  bool target_is_bone = false;  ///< it is touched, not entered
  NeedleReading needle;
  double needle_length = 0;  ///< m
};

/// Says what the task is and what to do next, in one line each; remembers that it was done.
class Guide {
 public:
  [[nodiscard]] std::string goal(const GuideInput& in) const;
  /// Follows the session and says what to do now.
  [[nodiscard]] std::string next(const GuideInput& in);
  [[nodiscard]] bool reached() const noexcept { return reached_; }
  /// Another task, or the same again.
  void begin_again() noexcept { reached_ = false; }

 private:
  [[nodiscard]] std::string with_needle(const GuideInput& in) const;
  bool reached_ = false;
};

}  // namespace artus
