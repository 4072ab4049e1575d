// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "artus/core/geometry.h"

namespace artus::kit {

/// Whether a tool counts as seen: gone after a while without a pose, back after three frames that
/// agree with each other.
class Presence {
 public:
  /// `gone_after`: s.
  explicit Presence(double gone_after) : gone_after_(gone_after) {}

  /// What a frame says; `time` must rise, s. Returns whether its pose may be given out.
  [[nodiscard]] bool take(double time, const std::optional<Pose>& pose);
  /// The last pose that was given out, if it is not too old to settle a doubt.
  [[nodiscard]] const Pose* recent(double time) const;

 private:
  double gone_after_;
  bool there_ = false;
  double seen_ = 0;  // s
  std::optional<Pose> last_;
  std::vector<Pose> agreeing_;
};

}  // namespace artus::kit
