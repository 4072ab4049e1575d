// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/core/check.h"
#include "artus/haptics/needle/needle_contact.h"
#include "artus/session/session_params.h"

namespace artus {

/// What helps a learner's needle hand in training: a spring across to the planned line, and
/// structures that push back. Neither is tissue: no test with them counts.
class HandAid {
 public:
  /// N that either of them ever gives; assumed: felt well, and less than a hand's own.
  static constexpr double kMostForce = 4;
  /// m within the skin over which the line begins to draw.
  static constexpr double kBegins = 5e-3;

  /// Names of `aids.keep_out` that the joint does not have are of no effect.
  HandAid(const CompiledJoint& joint, const HandAids& aids);

  /// One tick: N, frame J, with the tip at `tip` (m, frame J). Zero outside the skin.
  [[nodiscard]] ARTUS_REALTIME Vec3 step(const NeedleContact& contact, const Vec3& tip) noexcept;

 private:
  HandAids aids_;
  Vec3 direction_ = Vec3::UnitZ();
  std::vector<char> keep_out_;  // by region
  bool within_ = false;
  double entered_ = 0;  // m, depth at which the tip came into one to keep out of
};

}  // namespace artus
