// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>

#include "artus/core/geometry.h"
#include "artus/detail/core/check.h"
#include "artus/detail/core/units.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The gesture in two phases: the trainee explores freely with the probe, then an entry point is
/// chosen and the joint is turned and shifted so that it meets the one point where the device's
/// mechanics let a needle enter. Source [Alamilla2020] section 4.4.5.
enum class GesturePhase : std::uint32_t { exploring, inserting };
[[nodiscard]] const char* to_string(GesturePhase phase) noexcept;

struct GestureParams {
  Vec3 p_W = Vec3::Zero();      ///< m, the device's fixed insertion point
  Vec3 axis_W = Vec3::UnitZ();  ///< unit, direction in which its needle enters there
  double beside_probe = 30e-3;  ///< m from the footprint's centre to the needle, along the
                                ///< scanlines' row; assumed: half a 40 mm probe and a finger
  double steepness =
      45 * kDegree;  ///< rad between needle and footprint; assumed: a common approach
};

/// Where in frame J the needle would enter for a probe at X_JP, and in which direction: beside the
/// probe, in its image plane. Empty when there is no skin there.
struct EntryChoice {
  Vec3 p_J = Vec3::Zero();
  Vec3 direction_J = Vec3::UnitZ();  ///< unit, into the body
};
[[nodiscard]] ARTUS_REALTIME std::optional<EntryChoice> choose_entry(
    const Scene& scene, const Pose& X_JP, const GestureParams& params) noexcept;

/// The joint's new place: `choice` comes to the device's point and axis, by the smallest turn from
/// X_WJ. The turn is about the entry point.
[[nodiscard]] ARTUS_REALTIME Pose calibrate_joint(const Pose& X_WJ, const EntryChoice& choice,
                                                  const GestureParams& params) noexcept;

/// Follows the buttons; a button acts when it goes down.
class TwoPhaseGesture {
 public:
  TwoPhaseGesture(const GestureParams& params, const Pose& X_WJ) noexcept
      : params_(params), home_(X_WJ), X_WJ_(X_WJ) {}

  /// `X_WP`: empty when there is no probe. True when the joint was moved.
  ARTUS_REALTIME bool step(const Scene& scene, std::uint32_t buttons,
                           const std::optional<Pose>& X_WP) noexcept;
  ARTUS_REALTIME void reset() noexcept;

  // Monogram notation.  NOLINTNEXTLINE(readability-identifier-naming)
  [[nodiscard]] const Pose& X_WJ() const noexcept { return X_WJ_; }
  [[nodiscard]] GesturePhase phase() const noexcept { return phase_; }

 private:
  GestureParams params_;
  Pose home_;
  Pose X_WJ_;
  GesturePhase phase_ = GesturePhase::exploring;
  std::uint32_t last_buttons_ = 0;
};

}  // namespace artus
