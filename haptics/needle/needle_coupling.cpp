// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/needle_coupling.h"

#include <algorithm>
#include <cmath>

namespace artus {

NeedleCoupling::NeedleCoupling(double dt, const NeedleCouplingParams& params) noexcept
    : follow_(1 - std::exp(-dt / params.relaxation)), params_(params) {}

void NeedleCoupling::take(const NeedleCompliance& compliance) noexcept {
  const double before = stored();
  compliance_ = compliance;
  compliance_.points = std::min(compliance_.points, NeedleCompliance::kMax);
  if (!active()) {
    load_ = {};
    tip_displacement_ = 0;
  }
  given_ += stored() - before;
}

void NeedleCoupling::reset() noexcept {
  load_ = {};
  tip_displacement_ = 0;
  lost_ = 0;
  given_ = 0;
}

NeedleLoad NeedleCoupling::cube_load() const noexcept {
  NeedleLoad load = load_;
  if (!active() || load.tip == 0) return load;
  const double cubes = cube_compliance(compliance_, load.tip_depth);
  if (cubes > 0) load.tip *= tip_compliance(load.tip_depth, wall_stiffness_) / cubes;
  return load;
}

double NeedleCoupling::displacement(std::size_t point) const noexcept {
  double u = 0;
  for (std::size_t j = 0; j < compliance_.points; ++j)
    u += compliance_.by_load[point][j] * load_.shaft[j];
  return u;
}

double NeedleCoupling::stored() const noexcept {
  double energy = 0;
  for (std::size_t i = 0; i < compliance_.points; ++i)
    energy += 0.5 * load_.shaft[i] * displacement(i);
  return energy;
}

double NeedleCoupling::dragged(std::size_t point) const noexcept {
  return displacement(point) - compliance_.near_field[point] * load_.shaft[point];
}

double NeedleCoupling::tip_compliance(double depth, double wall_stiffness) const noexcept {
  if (!active()) return 0;
  const double tissue = cube_compliance(compliance_, depth);
  if (!(wall_stiffness > 0)) return tissue;
  return std::min(tissue, max_tissue_compliance(wall_stiffness));
}

void NeedleCoupling::follow_tip(double depth, double tip_force, double wall_stiffness) noexcept {
  load_.tip = tip_force;
  wall_stiffness_ = wall_stiffness;
  load_.tip_depth = depth;
  const TrackPlace b = find_on_track(compliance_, depth);
  const double shaft = (1 - b.share) * dragged(b.low) + b.share * dragged(b.high);
  const double pushed = shaft + tip_compliance(depth, wall_stiffness) * tip_force;
  tip_displacement_ += follow_ * (pushed - tip_displacement_);
}

double NeedleCoupling::step(double moved, double depth, double tip_force, double wall_stiffness,
                            std::span<const double> limits) noexcept {
  const std::size_t n = std::min(compliance_.points, limits.size());
  if (n == 0) return 0;
  const auto& C = compliance_.by_load;
  NeedleCompliance::Column slip{};  // of the shaft along the tissue
  for (std::size_t i = 0; i < n; ++i) slip[i] = moved;
  const auto change = [&](std::size_t i, double force) noexcept {
    const double by = force - load_.shaft[i];
    if (by == 0) return;
    load_.shaft[i] = force;
    for (std::size_t j = 0; j < n; ++j) slip[j] -= C[j][i] * by;
  };
  for (int sweep = 0; sweep < params_.sweeps; ++sweep) {
    for (std::size_t i = 0; i < n; ++i)
      change(i, std::clamp(load_.shaft[i] + slip[i] / C[i][i], -limits[i], limits[i]));
  }
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += load_.shaft[i];
    lost_ += load_.shaft[i] * slip[i];
  }
  follow_tip(depth, tip_force, wall_stiffness);
  return -sum;
}

}  // namespace artus
