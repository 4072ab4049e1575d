// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>

#include <Eigen/Core>

#include "artus/core/geometry.h"

namespace artus {

/// Below this share of its volume a part of a cube resists as its bulk does. Assumed: far below
/// what a probe's 3 N ask of a cube, far above where a part turns inside out.
inline constexpr double kMinPart = 0.4;
/// How steeply that grows where the bulk hardens: at half of kMinPart it is eleven times what it
/// would be without. Assumed: no part below a face's end may turn over under 10 N.
inline constexpr double kCrushRise = 20;

/// An eighth with less tissue than this counts as so much: cubes at the skin must not be flimsy.
/// What then is nearly all air may turn over: beside a face that is pressed deep the skin folds.
inline constexpr double kMinWeight = 0.15;

/// The mechanics of one cube: an average over its eighths, one integration point in each.
struct CellMaterial {
  std::array<double, 8> weight{};     ///< share of the eighth that is tissue, 0..1
  std::array<double, 8> shear{};      ///< Pa, mu that every deformation feels
  std::array<double, 8> sheet{};      ///< Pa, mu that only stretching in the sheet's plane feels
  std::array<double, 8> hardening{};  ///< b of SoftMaterial
  double bulk = 0;                    ///< Pa, lambda
  double firm_from = 0;               ///< of SoftMaterial; of the volume that does not drain
  double drain = 0;                   ///< share of the tissue that is fluid and can leave
  double drain_pressure = 0;          ///< Pa under which it does
  double fibre_modulus = 0;           ///< Pa
  Vec3 sheet_normal = Vec3::UnitZ();  ///< unit
  Vec3 fibre = Vec3::UnitX();         ///< unit
};

using CellVector = Eigen::Matrix<double, 24, 1>;  ///< (8 nodes, 3)
using CellMatrix = Eigen::Matrix<double, 24, 24>;

/// What a deformed cube answers.
struct CellResponse {
  CellVector force;       ///< N, on the nodes by the cube: minus the energy's gradient
  double energy = 0;      ///< J
  double min_volume = 1;  ///< smallest J of its integration points of more than kMinWeight
};

/// Trilinear cube with one mean dilatation (Q1P0), so that nearly incompressible tissue does not
/// lock: W = sum_g V_g [mu_g/b (exp(b psi_g) - 1) + W_sheet + W_fibre] + V lambda/2 (mean J -
/// J0)^2 + V lambda/(3 w) <J0 - mean J - v>^3 + sum_g V_g lambda/2 (x^2 + kCrushRise x^4), x = <1 -
/// J_g/kMinPart>, the last since a mean alone lets one corner of a cube vanish while the others
/// swell; v and w as in SoftMaterial. The sheet's energy mu_s/2 (tr c + 1/det c - 3) is that of an
/// incompressible membrane with the stretch c in the plane across `sheet_normal`. Fluid of a share
/// f that drains makes the pressure of a smaller volume, q = J0 - mean J, less: k q up to 0.8 f
/// with k = drain_pressure/f, beyond 1.2 f again with the slope lambda, between them the slope goes
/// over evenly; so much of the fluid has left for where nothing presses, and all of it comes back.
/// `u` m, frame C; `edge` m; `target` J0, 1 at rest. A model computes four cubes at once
/// (kernels.h).
[[nodiscard]] CellResponse cell_response(const CellMaterial& material, double edge,
                                         const CellVector& u, double target = 1) noexcept;

/// Where the slope of a draining cube's pressure begins and ends to rise, in its fluid's share.
inline constexpr double kDrainBegin = 0.8;
inline constexpr double kDrainEnd = 1.2;

/// Of firm_from: w of SoftMaterial, by which the slope of the bulk grows by twice itself.
inline constexpr double kFirmRise = 0.1;

/// Second derivative of the energy, with the parts that could make it indefinite held back: at each
/// point whose stress is above mu what has negative stiffness, a sheet's compression, a fibre's
/// slack. What stiffens is all there: without it, steps under pressures far above mu pass their end
/// and turn back for ever. For steps that converge, not exact. Cost: about 20 us, twice that where
/// stresses are above mu.
[[nodiscard]] CellMatrix cell_tangent(const CellMaterial& material, double edge,
                                      const CellVector& u, double target = 1) noexcept;

/// Deformation gradient at the cube's centre.
[[nodiscard]] Eigen::Matrix3d cell_gradient(double edge, const CellVector& u) noexcept;

/// Pa on the cube's volume where its mean dilatation is `J`: what is squeezed presses.
[[nodiscard]] double cell_pressure(const CellMaterial& material, double J,
                                   double target = 1) noexcept;

/// Mean dilatation J of the cube's tissue.
[[nodiscard]] double cell_dilatation(const CellMaterial& material, double edge,
                                     const CellVector& u) noexcept;

}  // namespace artus
