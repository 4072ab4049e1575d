// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/two_phase_gesture.h"

#include <array>
#include <cmath>

#include "artus/simulation/input_device.h"

namespace artus {

const char* to_string(GesturePhase phase) noexcept {
  return phase == GesturePhase::exploring ? "exploring" : "inserting";
}

std::optional<EntryChoice> choose_entry(const Scene& scene, const Pose& X_JP,
                                        const GestureParams& params) noexcept {
  constexpr double kReach = 40e-3;  // m above and below the footprint where skin is looked for
  const Vec3 beside = X_JP * Vec3(-params.beside_probe, 0, 0);
  const Vec3 down = X_JP.linear().col(2);
  const Segment line{beside - kReach * down, beside + kReach * down};
  std::array<Crossing, 16> crossings;
  const QueryCount count = scene.find_crossings(line, crossings);
  for (std::size_t i = 0; i < count.size; ++i) {
    if (crossings[i].from != kOutside) continue;
    const Vec3 in_plane(std::cos(params.steepness), 0, std::sin(params.steepness));
    return EntryChoice{line.start + crossings[i].depth * down, X_JP.linear() * in_plane};
  }
  return std::nullopt;
}

Pose calibrate_joint(const Pose& X_WJ, const EntryChoice& choice,
                     const GestureParams& params) noexcept {
  const Vec3 direction_W = X_WJ.linear() * choice.direction_J;
  const Eigen::Quaterniond turn = rotation_between(direction_W, params.axis_W);
  Pose moved = Pose::Identity();
  moved.linear() = turn.toRotationMatrix() * X_WJ.linear();
  moved.translation() = params.p_W - moved.linear() * choice.p_J;
  return moved;
}

bool TwoPhaseGesture::step(const Scene& scene, std::uint32_t buttons,
                           const std::optional<Pose>& X_WP) noexcept {
  const std::uint32_t down = buttons & ~last_buttons_;
  last_buttons_ = buttons;
  if ((down & Button::kExplore) != 0 && phase_ == GesturePhase::inserting) {
    reset();
    return true;
  }
  if ((down & Button::kCalibrate) == 0 || phase_ != GesturePhase::exploring || !X_WP) return false;
  const auto choice = choose_entry(scene, X_WJ_.inverse() * *X_WP, params_);
  if (!choice) return false;
  X_WJ_ = calibrate_joint(X_WJ_, *choice, params_);
  phase_ = GesturePhase::inserting;
  return true;
}

void TwoPhaseGesture::reset() noexcept {
  X_WJ_ = home_;
  phase_ = GesturePhase::exploring;
}

}  // namespace artus
