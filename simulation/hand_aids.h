// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/core/check.h"
#include "artus/detail/haptics/needle/needle_contact.h"
#include "artus/simulation/session_params.h"

namespace artus {

/// What helps a learner's needle hand in training: a spring across to the planned line, and
/// structures that push back. Neither is tissue: no test with them counts.
class HandAid {
 public:
  /// N that either of them ever gives; assumed: felt well, and less than a hand's own.
  static constexpr double kMaxForce = 4;
  /// m within the skin over which the line begins to draw.
  static constexpr double kBegins = 5e-3;

  /// N/s by which it comes and goes at most, whatever the needle does; assumed.
  static constexpr double kSlew = 100;

  /// Names of `aids.keep_out` that the joint does not have are of no effect. `period`: s, of a
  /// tick.
  HandAid(const CompiledJoint& joint, const HandAids& aids, double period);

  /// One tick: N, frame J, with the tip at `tip` (m, frame J). Fades to zero outside the skin; at
  /// once zero, and from there again, when the session does not run.
  [[nodiscard]] ARTUS_REALTIME Vec3 step(const NeedleContact& contact, const Vec3& tip,
                                         bool runs) noexcept;

 private:
  [[nodiscard]] Vec3 wanted(const NeedleContact& contact, const Vec3& tip) noexcept;

  HandAids aids_;
  double max_step_;  // N
  Vec3 force_ = Vec3::Zero();
  Vec3 direction_ = Vec3::UnitZ();
  std::vector<char> keep_out_;  // by region
  bool within_ = false;
  double entered_ = 0;  // m, depth at which the tip came into one to keep out of
};

}  // namespace artus
