// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/guard.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/rigid.h"

namespace artus {
namespace {

Vec3 limit_step(const Vec3& from, const Vec3& to, double step, bool& limited) noexcept {
  const Vec3 change = to - from;
  const double norm = change.norm();
  if (norm <= step) return to;
  limited = true;
  return from + change * (step / norm);
}

}  // namespace

std::uint32_t InputGuard::check(const TimedPose& pose) noexcept {
  if (pose.check == TimedPose::Check::absent) return TickStatus::kNotFinite;
  if (pose.check == TimedPose::Check::none) {
    if (!pose.X_JN.matrix().allFinite() || !std::isfinite(pose.time)) return TickStatus::kNotFinite;
    if (!is_rigid(pose.X_JN)) return TickStatus::kNotRigid;
  }
  std::uint32_t faults = 0;
  const Vec3 off = (pose.X_JN.translation() - params_.workspace_centre).cwiseAbs();
  if ((off.array() > params_.workspace_half.array()).any()) faults |= TickStatus::kOutOfWorkspace;
  const double stale_after = std::max(params_.stale_after, pose.hold);
  if (have_last_) {
    const double elapsed = pose.time - last_.time;
    if (elapsed < 0) {
      last_.time = pose.time;  // the clock that now counts; the tick itself is refused
      unchanged_ = 0;
      return faults | TickStatus::kTimeReversed;
    }
    unchanged_ = elapsed > 0 ? 0 : unchanged_ + dt_;
    if (unchanged_ > stale_after) faults |= TickStatus::kStale;
    const double since = std::clamp(elapsed, dt_, stale_after);
    const double moved = (pose.X_JN.translation() - last_.X_JN.translation()).norm();
    const double cosine =
        0.5 * ((last_.X_JN.linear().transpose() * pose.X_JN.linear()).trace() - 1);
    const double turned = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (moved > params_.max_speed * since || turned > params_.max_turn_rate * since) {
      faults |= TickStatus::kTeleport;
    }
  }
  last_ = pose;
  have_last_ = true;
  return faults;
}

Wrench OutputGuard::apply(const Wrench& wanted, std::uint32_t faults,
                          std::uint32_t& status) noexcept {
  status |= faults;
  if (!wanted.force.allFinite() || !wanted.torque.allFinite()) status |= TickStatus::kLawNotFinite;
  if ((status & TickStatus::kFaults) != 0) {
    engaged_ = 0;
    last_ = Wrench{};
    return last_;
  }
  const bool fading = (status & TickStatus::kTruncated) != 0;
  engaged_ = std::clamp(engaged_ + (fading ? -dt_ : dt_), 0.0, params_.ramp_time);
  const double ramp = engaged_ / params_.ramp_time;
  if (ramp < 1) status |= TickStatus::kRamping;
  const Wrench limited = saturate(device_, wanted);
  // What the device does not render at all has no limit to reach.
  const bool torque = device_.torque > 0 && limited.torque != wanted.torque;
  if (limited.force != wanted.force || torque) status |= TickStatus::kSaturated;
  bool slewed = false;
  last_.force = limit_step(last_.force, ramp * limited.force, params_.force_slew * dt_, slewed);
  last_.torque = limit_step(last_.torque, ramp * limited.torque, params_.torque_slew * dt_, slewed);
  if (slewed) status |= TickStatus::kSlewLimited;
  // A step between two wrenches within a ball stays in it: nothing leaves the device's limits.
  ARTUS_ASSERT(last_.force.norm() <= device_.force * (1 + 1e-9));
  ARTUS_ASSERT(last_.torque.norm() <= device_.torque * (1 + 1e-9));
  return last_;
}

}  // namespace artus
