// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "artus/detail/core/check.h"
#include "artus/detail/soft/solver/soft_solver.h"

namespace artus {

/// How the tissue around a straight track gives way along it: what a fast loop needs to know of the
/// body between two of its updates. Point i stands for the stretch of the track around the depth
/// (i + 1/2) * spacing from the skin.
struct NeedleCompliance {
  static constexpr std::size_t kMax = 16;
  using Column = std::array<double, kMax>;

  std::size_t points = 0;              ///< 0: the tissue is rigid
  double spacing = 2.5e-3;             ///< m
  std::array<Column, kMax> by_load{};  ///< m/N, symmetric, positive definite
  Column near_field{};                 ///< m/N, what of by_load's diagonal the needle's own
                                       ///< neighbourhood adds to the field of the cubes
};

/// The forces of a needle on the tissue along its track, N, positive into the body.
struct NeedleLoad {
  NeedleCompliance::Column shaft{};
  double tip = 0;
  double tip_depth = 0;  ///< m, material
};

/// The two points around a depth.
struct TrackPlace {
  std::size_t low = 0;
  std::size_t high = 0;
  double share = 0;  ///< of the high one
};
/// Where `depth` (m) lies between a track's points, the nearest one beyond their ends. Requires: a
/// point.
[[nodiscard]] ARTUS_REALTIME TrackPlace find_on_track(const NeedleCompliance& compliance,
                                                      double depth) noexcept;
/// m/N of a force at `depth` on what lies there, by the cubes alone: without the needle's own
/// neighbourhood. Requires: a point.
[[nodiscard]] ARTUS_REALTIME double cube_compliance(const NeedleCompliance& compliance,
                                                    double depth) noexcept;
/// m along the track by which the cubes at the load's tip give way to it. Zero without points.
[[nodiscard]] ARTUS_REALTIME double cube_displacement(const NeedleCompliance& compliance,
                                                      const NeedleLoad& load) noexcept;

/// A track in the body's rest shape, frame C of the cage.
struct NeedleLine {
  Vec3 entry = Vec3::Zero();  ///< m, on the skin
  Vec3 axis = Vec3::UnitZ();  ///< unit, into the body
  double length = 40e-3;      ///< m
  double radius = 0.36e-3;    ///< m, of the needle; 22 G
};

/// Compliance of the track's points by the factor, C = G K^-1 G^T. A force on a
/// line inside a cube only feels a cube's stiffness, so the field between the needle's radius r and
/// the radius R at which the cube's field begins is added to each point: ln(R/r) / (2 pi mu l), l
/// the point's length and mu the tissue's shear modulus there; R is 0.2 to 0.7 cubes, by where the
/// track passes between the nodes. It is the shaft's, given apart as `near_field`: what lies that
/// close to the tip is in the laws of cutting and puncture, which were measured at the hand. Points
/// in what is held are as rigid as that near field.
/// Requires: length and radius > 0. Cost: a solution of the factor for each point.
[[nodiscard]] NeedleCompliance compute_needle_compliance(const FactoredModel& factored,
                                                         const NeedleLine& track,
                                                         std::size_t points = 16);

/// The loads that a needle's forces are on the body, with `spacing` between its points.
[[nodiscard]] std::vector<PointLoad> loads_of(const NeedleLoad& load, const NeedleLine& track,
                                              double spacing);

}  // namespace artus
