// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <span>

#include "artus/detail/core/check.h"
#include "artus/detail/soft/solver/needle_compliance.h"

namespace artus {

struct NeedleCouplingParams {
  double relaxation = 0.02;  ///< s in which tissue follows the tip's force to 63 %; assumed: a tent
                             ///< falls to a tenth within 46 ms
  int sweeps = 8;            ///< over the points a tick
};

/// m/N that tissue has at most which was measured with a layer's K_t (`wall_stiffness`, N/m > 0):
/// the rest of the hand's path is in the tip's own neighbourhood, where it cuts.
[[nodiscard]] inline double max_tissue_compliance(double wall_stiffness) noexcept {
  constexpr double kShare = 7.0 / 8;  // of 1/K_t; assumed
  return kShare / wall_stiffness;
}

/// Tissue that gives way to a needle, in the fast loop. The tip's force pushes the tissue before
/// it, so that the tip is less deep in the material than in space. That path is part of the one
/// which the laws' stiffness was measured with: it says where layers are met and what the picture
/// shows, not how stiff the hand finds them. The shaft holds the tissue along the track and drags
/// it until friction gives way, point by point (stick and slip). The forces on the tissue minimise
/// 1/2 l^T C l with |l_i| <= f_i under the shaft's motion, so friction takes energy in every tick.
/// With no compliance set it does nothing: the tissue is rigid.
class NeedleCoupling {
 public:
  /// Requires: dt > 0 s, the fixed period of the loop; sweeps > 0.
  explicit NeedleCoupling(double dt, const NeedleCouplingParams& params = {}) noexcept;

  /// What the body is like from now on. Forces stay, unless it is rigid; the energy stored changes
  /// and is metered by given().
  ARTUS_REALTIME void take(const NeedleCompliance& compliance) noexcept;
  ARTUS_REALTIME void reset() noexcept;

  [[nodiscard]] bool active() const noexcept { return compliance_.points > 0; }
  /// How far the tissue at the tip is pushed in, m along the axis.
  [[nodiscard]] double tip_displacement() const noexcept { return tip_displacement_; }
  /// m/N of the tissue around the tip, at `depth` (m) in the material: the cubes' own field,
  /// without the needle's neighbourhood. A layer's K_t (`wall_stiffness`, N/m; 0: none is known)
  /// was measured with the tissue in it, so the tissue has max_tissue_compliance() at most.
  [[nodiscard]] ARTUS_REALTIME double tip_compliance(double depth,
                                                     double wall_stiffness = 0) const noexcept;
  [[nodiscard]] std::size_t points() const noexcept { return compliance_.points; }
  [[nodiscard]] double depth_of(std::size_t point) const noexcept {
    return (static_cast<double>(point) + 0.5) * compliance_.spacing;
  }
  [[nodiscard]] double spacing() const noexcept { return compliance_.spacing; }
  /// m of the shaft between two depths, m, that a point stands for: no border that passes a point
  /// changes what holds it all at once.
  [[nodiscard]] ARTUS_REALTIME double held_by(std::size_t point, double from,
                                              double to) const noexcept {
    const double begin = static_cast<double>(point) * compliance_.spacing;
    return std::max(0.0, std::min(to, begin + compliance_.spacing) - std::max(from, begin));
  }

  /// Advances by one period in which the needle moved by `moved` m along its axis in space. `depth`
  /// m: of the tip in the material; `tip_force` N that the tip puts on the tissue, whose layer has
  /// `wall_stiffness` (tip_compliance); `limits` N that friction can hold at each point: those
  /// behind the tip only. Returns the shaft's force on the hand, N along the axis.
  ARTUS_REALTIME double step(double moved, double depth, double tip_force, double wall_stiffness,
                             std::span<const double> limits) noexcept;

  [[nodiscard]] const NeedleLoad& load() const noexcept { return load_; }
  /// The load under which the cubes give way as the hand feels it: of the tip's force the share
  /// that moves them by tip_compliance(), where they are softer than K_t says.
  [[nodiscard]] ARTUS_REALTIME NeedleLoad cube_load() const noexcept;
  [[nodiscard]] double stored() const noexcept;                       ///< J, by the shaft's forces
  [[nodiscard]] double dissipated() const noexcept { return lost_; }  ///< J, by friction
  [[nodiscard]] double given() const noexcept { return given_; }      ///< J, by new compliances

 private:
  [[nodiscard]] double displacement(std::size_t point) const noexcept;  // by the shaft's forces
  [[nodiscard]] double dragged(std::size_t point) const noexcept;       // beside the shaft
  void follow_tip(double depth, double tip_force, double wall_stiffness) noexcept;

  double follow_;  // share of the displacement in a tick
  NeedleCouplingParams params_;
  NeedleCompliance compliance_;
  NeedleLoad load_;
  double wall_stiffness_ = 0;  // N/m, K_t where the tip is
  double tip_displacement_ = 0;
  double lost_ = 0;
  double given_ = 0;
};

}  // namespace artus
