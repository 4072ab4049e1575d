// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "artus/detail/core/check.h"
#include "artus/detail/simulation/plain_pose.h"

namespace artus {

/// How the other side of a device is.
enum class PeerState : std::uint32_t {
  absent,  ///< nothing was ever heard
  alive,   ///< its newest sample is fresh
  lost,    ///< silent for longer than kPeerTimeout
  invalid  ///< it sends what cannot be a pose
};
[[nodiscard]] const char* to_string(PeerState state) noexcept;

/// Silence after which a device counts as lost, ns. Below the 20 ms that the protocol promises, so
/// that a tick and the delay to the device fit in between.
inline constexpr std::int64_t kPeerTimeout = 15'000'000;  // ns

/// The longest that a device may have its pose held: three samples of one at 30 Hz, ms.
inline constexpr std::uint32_t kLongestHold = 100;

struct Button {
  static constexpr std::uint32_t kCalibrate = 1U << 0U;  ///< choose the entry point
  static constexpr std::uint32_t kExplore = 1U << 1U;    ///< give it up again
};

/// What a device says of its plunger.
enum class PlungerSign : std::uint32_t {
  none,    ///< it has none
  travel,  ///< where it is: what pushes back is a spring between it and the stopper
  force    ///< how hard the thumb pushes
};

/// What a device says in one tick. World frame W. Plain bytes: this is what is recorded.
struct DeviceSample {
  PlainPose X_WN;            ///< needle
  PlainPose X_WP;            ///< probe
  std::int64_t time_ns = 0;  ///< monotonic clock, when it was measured
  std::uint64_t number = 0;  ///< grows with every sample of the device
  std::uint32_t buttons = 0;
  PeerState state = PeerState::absent;
  std::uint32_t has_needle = 0;  ///< 0 or 1
  std::uint32_t has_probe = 0;   ///< 0 or 1
  double plunger_travel = 0;     ///< m, positive in
  double plunger_force = 0;      ///< N of the thumb, positive in
  PlungerSign plunger = PlungerSign::none;
  std::uint32_t hold_ms = 0;  ///< ms that it may let pass between two samples; 0: kPeerTimeout
};
static_assert(std::is_trivially_copyable_v<DeviceSample>);

/// What the syringe does in a tick. Plain bytes.
struct PlungerFeedback {
  double thumb_force = 0;    ///< N on the thumb, positive out of the barrel
  double pressure = 0;       ///< Pa in the barrel
  double tip_pressure = 0;   ///< Pa around the bevel
  double flow = 0;           ///< m^3/s out of the tip
  double travel = 0;         ///< m, positive in
  double given = 0;          ///< m^3 out of the tip in all
  double drawn = 0;          ///< m^3 of the patient's own
  std::uint32_t status = 0;  ///< PlungerStatus bits
  std::uint32_t reserved = 0;
};

/// What a device is told in one tick. World frame W.
struct DeviceFeedback {
  double force[3] = {0, 0, 0};   ///< N  NOLINT(*-avoid-c-arrays)
  double torque[3] = {0, 0, 0};  ///< N m  NOLINT(*-avoid-c-arrays)
  double stiffness = 0;          ///< N/m of the layer at the tip
  double cutting_force = 0;      ///< N
  double depth = 0;              ///< m
  std::uint64_t tick = 0;
  std::uint64_t answers = 0;        ///< DeviceSample::number
  std::int64_t sample_time_ns = 0;  ///< DeviceSample::time_ns
  std::int64_t time_ns = 0;
  std::uint32_t status = 0;
  std::uint32_t contact = 0;
  std::uint32_t region = 0;
  std::uint32_t probe_status = 0;  ///< TickStatus bits of the probe's force; kStale: it has no pose
  double probe_force[3] = {0, 0, 0};   ///< N, at the face's centre  NOLINT(*-avoid-c-arrays)
  double probe_torque[3] = {0, 0, 0};  ///< N m  NOLINT(*-avoid-c-arrays)
  double probe_share = 0;              ///< of the face that presses, 0..1
  double tissue_age = 0;               ///< s, of the tissue that is felt; 0: none gives way
  PlungerFeedback plunger;
};

/// Whether what it says of its plunger can be: finite, within a metre and a kilonewton.
[[nodiscard]] bool is_plunger(const DeviceSample& sample) noexcept;

/// Whether its pose may be held for as long as it asks.
[[nodiscard]] inline bool is_hold(std::uint32_t hold_ms) noexcept {
  return hold_ms <= kLongestHold;
}
/// How long its pose is held, ns: kPeerTimeout unless it asks for longer.
[[nodiscard]] inline std::int64_t hold_of(const DeviceSample& sample) noexcept {
  constexpr std::int64_t kMillisecond = 1'000'000;  // ns
  return std::max(kPeerTimeout, kMillisecond * static_cast<std::int64_t>(sample.hold_ms));
}

/// One source of poses and one sink of forces: a shared-memory peer, a simulated hand, a recorded
/// file, mouse and keyboard. The haptic thread alone calls read and write.
class InputDevice {
 public:
  InputDevice() = default;
  InputDevice(const InputDevice&) = delete;
  InputDevice& operator=(const InputDevice&) = delete;
  virtual ~InputDevice() = default;

  /// The newest sample; never waits. `now_ns`: monotonic clock of this tick.
  [[nodiscard]] ARTUS_REALTIME virtual DeviceSample read(std::int64_t now_ns) noexcept = 0;
  ARTUS_REALTIME virtual void write(const DeviceFeedback& feedback) noexcept = 0;
  /// Mends what the outside world spoiled and says so, a line each. A few times a second, from
  /// another thread than read and write.
  [[nodiscard]] virtual std::vector<std::string> repair_connection() { return {}; }
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
};

}  // namespace artus
