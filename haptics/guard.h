// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <limits>
#include <utility>

#include "artus/haptics/device.h"

namespace artus {

/// Why a tick rendered no force, or less than the law asked for; a bit field.
struct TickStatus {
  static constexpr std::uint32_t kOk = 0;
  static constexpr std::uint32_t kNotFinite = 1U << 0U;
  static constexpr std::uint32_t kNotRigid = 1U << 1U;
  static constexpr std::uint32_t kTeleport = 1U << 2U;
  static constexpr std::uint32_t kTimeReversed = 1U << 3U;
  static constexpr std::uint32_t kStale = 1U << 4U;
  static constexpr std::uint32_t kOutOfWorkspace = 1U << 5U;
  static constexpr std::uint32_t kLawNotFinite = 1U << 6U;
  static constexpr std::uint32_t kLate = 1U << 7U;
  static constexpr std::uint32_t kRamping = 1U << 8U;
  static constexpr std::uint32_t kSlewLimited = 1U << 9U;
  static constexpr std::uint32_t kSaturated = 1U << 10U;
  static constexpr std::uint32_t kTruncated = 1U << 11U;  ///< a line met more than a query holds
  /// Those that force the output to zero.
  static constexpr std::uint32_t kFaults = (1U << 8U) - 1;
};

struct GuardParams {
  double max_speed = 2;       ///< m/s of the tip; faster is a teleport. assumed: hand < 1 m/s
  double max_turn_rate = 40;  ///< rad/s; assumed: wrist < 20 rad/s
  double stale_after = 0.02;  ///< s without a newer pose; assumed: 20 periods at 1 kHz
  double ramp_time = 0.2;     ///< s from zero to full force after engagement or a fault; assumed
  double force_slew = 4000;   ///< N/s; assumed: above the source's tap (19.9 * 2 pi 55 * 0.5 m/s)
  double torque_slew = 200;   ///< N m/s; assumed, in proportion to the force
  Vec3 workspace_centre = Vec3::Zero();                                           ///< m, frame J
  Vec3 workspace_half = Vec3::Constant(std::numeric_limits<double>::infinity());  ///< m
};

/// A pose as an input device gives it: tip pose and the time it was sampled.
struct TimedPose {
  /// What is known of a pose before the tick looks at it.
  enum class Check {
    none,   ///< nothing: it is looked at here
    done,   ///< it is finite and rigid, as a border has made sure
    absent  ///< there is none in this tick
  };
  Pose X_JN = Pose::Identity();
  double time = 0;  ///< s, never decreasing
  double hold = 0;  ///< s that its device may let pass between two poses; below stale_after: that
  Check check = Check::none;
};

/// The first stage of the tick: refuses poses that no hand can make.
class InputGuard {
 public:
  InputGuard(const GuardParams& params, double dt) noexcept : params_(params), dt_(dt) {}

  /// Faults of this pose (TickStatus bits); a faulty pose is never the base for the next
  /// comparison, except a teleport, whose end is where the needle now is.
  [[nodiscard]] ARTUS_REALTIME std::uint32_t check(const TimedPose& pose) noexcept;

 private:
  GuardParams params_;
  double dt_;
  bool have_last_ = false;
  TimedPose last_;
  double unchanged_ = 0;  // s since the pose's time advanced
};

/// The last stage before a device: finite, ramp, norm (direction kept), slew; zero on any fault, at
/// once; the ramp goes down while a query is truncated. Never a filter that hides an unstable law.
/// Source: the chain of libfranka [Franka].
class OutputGuard {
 public:
  OutputGuard(const GuardParams& params, DeviceLimits device, double dt)
      : params_(params), device_(std::move(device)), dt_(dt) {}

  /// `faults`: TickStatus bits of this tick's earlier stages. Adds what this stage did to `status`.
  [[nodiscard]] ARTUS_REALTIME Wrench apply(const Wrench& wanted, std::uint32_t faults,
                                            std::uint32_t& status) noexcept;
  /// Whether any force can pass; not after a fault, nor when the ramp has gone down.
  [[nodiscard]] bool engaged() const noexcept { return engaged_ > 0; }

 private:
  GuardParams params_;
  DeviceLimits device_;
  double dt_;
  Wrench last_;
  double engaged_ = 0;  // s since the last fault or the start, of the ramp's time
};

}  // namespace artus
