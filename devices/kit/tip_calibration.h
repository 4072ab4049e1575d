// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus::kit {

/// Where a needle's tip is on its syringe, found by turning it about a fixed point.
struct TipFit {
  Vec3 tip_B = Vec3::Zero();
  Vec3 pivot = Vec3::Zero();  ///< in the frame of the poses
  double condition = 0;       ///< of the equations: 25 for a cone of 10 degrees, 8 for 30
  double scatter = 0;         ///< m, 95 % of the tip around the pivot
  double error = 0;           ///< m, told: see fit_tip
};

/// [R -I][tip; pivot] = -t in the least squares. `X_SB`: poses while the tip rests in a pit. The
/// error told is the largest of: twice the bootstrap's standard deviation; twice half the gap
/// between the tips of two halves of the cone (by direction); 95 % of the scatter; and, by
/// `with_divots`, by how much two pits 60 mm apart seem to be otherwise. It covers the truth where
/// the rms does not: glue and lens shift all poses alike. Errors: invalid (fewer than 60 poses, a
/// condition above 12: the cone is too narrow, turn it by 25 degrees and more to all sides).
[[nodiscard]] Result<TipFit> fit_tip(const std::vector<Pose>& X_SB);

/// Touches of two pits: the tip rests in one, then in the other. Returns the fit with an error that
/// covers them, too. Errors: invalid (fewer than 10 poses of each; 60 mm seem to be off by more
/// than 5 mm: another pit, or a wrong scale of the print).
[[nodiscard]] Result<TipFit> with_divots(const TipFit& fit,
                                         const std::array<std::vector<Pose>, 2>& X_SB);

/// The needle's direction from poses while it rolls by 45 degrees to both sides about itself, hub
/// to tip. Errors: invalid (it rolled by less than 30 degrees in all).
[[nodiscard]] Result<Vec3> fit_axis(const std::vector<Pose>& X_SB, const Vec3& nominal_B);

/// The needle's frame on the syringe: tip, and an axis (z) that is hub to tip.
[[nodiscard]] Pose needle_on_syringe(const Vec3& tip_B, const Vec3& axis_B);

/// The probe's face from touches by the needle's tip in the probe's frame: the end at its mark,
/// middle, other end.
struct FaceFit {
  Pose X_BP;
  double error = 0;  ///< m, told: scatter, and how far the marks' distance and line are off
};
/// Errors: invalid (fewer than 6 touches of a place; marks whose distance is off by more than 4
/// mm).
[[nodiscard]] Result<FaceFit> fit_face(const std::array<std::vector<Vec3>, 3>& touches_B,
                                       const Pose& nominal, double tip_error);

}  // namespace artus::kit
