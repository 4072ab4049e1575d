// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "artus/detail/haptics/needle/needle_coupling.h"
#include "artus/detail/simulation/syringe_core.h"
#include "artus/detail/simulation/tissue_packet.h"
#include "artus/detail/simulation/two_phase_gesture.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/simulation/input_device.h"
#include "artus/simulation/session_params.h"

namespace artus {

/// Status bits of a session's tick, above those of TickStatus; also in FORCE.
struct SessionStatus {
  static constexpr std::uint32_t kPeerLost = 1U << 16U;
  static constexpr std::uint32_t kPeerInvalid = 1U << 17U;
  static constexpr std::uint32_t kPaused = 1U << 18U;
  static constexpr std::uint32_t kStopped = 1U << 19U;
  static constexpr std::uint32_t kNoNeedle = 1U << 21U;
  /// What the hands feel is tissue older than 0.1 s: skin and stiffness are held as last known.
  static constexpr std::uint32_t kTissueLate = 1U << 23U;
};

/// What the people at the session want in a tick; bits.
struct SessionCommand {
  static constexpr std::uint32_t kPause = 1U << 0U;
  static constexpr std::uint32_t kReset = 1U << 1U;  ///< in one tick: forget the insertion
  static constexpr std::uint32_t kLate = 1U << 2U;   ///< the loop is late for too long: no force
  static constexpr std::uint32_t kAll = kPause | kReset | kLate;
};

/// Everything that goes into a haptic tick. Plain bytes: a recording is a row of these.
struct TickInput {
  DeviceSample device;
  std::uint64_t tick = 0;
  std::uint32_t command = 0;
  std::uint32_t reserved = 0;
};

/// Everything that comes out of one and others may want to see. Frame J unless named; plain bytes.
struct HapticSnapshot {
  TickInput input;  ///< as taken: poses that cannot be are replaced by those before and invalid
  PlainPose X_WJ;
  PlainPose X_JN;
  PlainPose X_JP;
  DeviceFeedback feedback;  ///< as sent to the device, frame W
  double axial[5] = {};     ///< N along the needle: prepuncture, cutting, attracted, friction, hard
                            ///< NOLINT(*-avoid-c-arrays)
  double clamping = 0;      ///< N, norm
  double clamping_J[3] = {};   ///< N  NOLINT(*-avoid-c-arrays)
  double surface_J[3] = {};    ///< N, of the god-object  NOLINT(*-avoid-c-arrays)
  double workspace_J[3] = {};  ///< N, of the hemisphere  NOLINT(*-avoid-c-arrays)
  double force_J[3] = {};      ///< N, as sent, frame J  NOLINT(*-avoid-c-arrays)
  double torque_J[3] = {};     ///< N m  NOLINT(*-avoid-c-arrays)
  double entry_J[3] = {};      ///< m, where the needle went in  NOLINT(*-avoid-c-arrays)
  double cone = 0;             ///< rad, within which the needle may turn
  NeedleLoad load;             ///< of the needle on the tissue, N; zero where it is rigid
  std::uint32_t status = 0;
  std::uint32_t events = 0;  ///< ContactEvent bits
  GesturePhase phase = GesturePhase::exploring;
  std::uint32_t inserted = 0;
  InjectedSite sites[kMaxSites] = {};  ///< NOLINT(*-avoid-c-arrays)
  std::uint32_t n_sites = 0;
  std::uint32_t reserved = 0;
};
static_assert(std::is_trivially_copyable_v<TickInput>);
static_assert(std::is_trivially_copyable_v<HapticSnapshot>);

/// What the person at the scanner turns while the session runs. Plain bytes.
struct ImageControls {
  double depth = 40e-3;  ///< m
  double gain_db = 0;
  double tgc_db_cm_mhz = 0.7;
  double dynamic_range_db = 60;
  double frequency = 12e6;         ///< Hz
  double elevation_focus = 20e-3;  ///< m
  double persistence = 0;          ///< 0 none .. <1 share of the image before
  GreyCurve grey_curve;
  Look look = Look::clinical;
  std::array<std::uint8_t, 3> reserved{};
  std::uint32_t compound_angles = 1;  ///< steered frames, odd; a curved probe steers none
  MotionShown motion = MotionShown::none;
  std::uint32_t more_reserved = 0;
  friend bool operator==(const ImageControls&, const ImageControls&) = default;
};
[[nodiscard]] ImageControls controls_of(const SessionParams& params) noexcept;

/// Everything that goes into an image. Plain bytes.
struct FrameInput {
  PlainPose X_JP;
  PlainPose X_JN;
  ImageControls controls;
  std::int64_t sample_time_ns = 0;  ///< DeviceSample::time_ns of the poses
  std::uint64_t number = 0;
  std::uint32_t has_needle = 0;
  std::uint32_t has_probe = 0;
  InjectedSite sites[kMaxSites] = {};  ///< what liquid went to  NOLINT(*-avoid-c-arrays)
  std::uint32_t n_sites = 0;
  std::uint32_t reserved = 0;
  NeedleLoad load;         ///< as HapticSnapshot::load
  std::uint64_t tick = 0;  ///< that the poses are of
};
static_assert(std::is_trivially_copyable_v<FrameInput>);

/// The poses of a tick as an image's input.
[[nodiscard]] FrameInput frame_input(const HapticSnapshot& snapshot, const ImageControls& controls,
                                     std::uint64_t number) noexcept;

/// A number that two images share only when their bytes are the same, as far as 64 bits can tell.
[[nodiscard]] std::uint64_t digest_of(const Frame& frame) noexcept;
/// The same of a packet.
[[nodiscard]] std::uint64_t digest_of(const TissuePacket& packet) noexcept;

}  // namespace artus
