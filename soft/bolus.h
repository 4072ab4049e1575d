// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "artus/anatomy/body/compiled_joint.h"

namespace artus {

/// A lens of liquid that parts tissue along a sheet: z = slope.p + p.bend p / 2 over p = (x, y)
/// along the first two axes. Its outline there is an ellipse, its opening that of an ellipsoid.
struct Bolus {
  RegionId region = kFirstRegion;                      ///< that it lies in
  Vec3 centre = Vec3::Zero();                          ///< m, frame J, of the sheet
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< unit, in columns; the last: it opens
  Vec3 proportion = Vec3::Ones();                      ///< of the semi-axes
  double volume = 0;                                   ///< m^3
  double up = 0.5;  ///< share of the opening that goes along the last axis, the rest against it
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  Eigen::Matrix2d bend = Eigen::Matrix2d::Zero();  ///< 1/m
};

/// Unit, frame J, along the fibres of a region at a point of frame J; zero where that is unknown.
using FibreField = std::function<Vec3(RegionId, const Vec3&)>;

/// What a volume that comes in at `tip` opens in a region, in the order of opening, the one around
/// the tip last. Muscle: streaks along the fibres between its fascicles, 10 : 5 : 0.7 mm, 0.15 ml
/// each, in sheets 1 mm apart. Tendon and what else has fibres: clefts of 12 : 8 : 0.6 mm, 0.24 ml
/// each, in sheets 0.45 mm apart between fibrils that stay. Nerve: 12 : 3 : 1 mm; fat: one lens of
/// 4 : 4 : 1. The sheets follow the fibres (`fibres`, or the region's axis along its walls); what
/// opens keeps within the walls. With bone behind all opens the other way. Where nothing more has
/// room farther along the fibres all become thicker, up to an opening of 5 mm, and then wider:
/// only then walls are parted, too. assumed: all sizes.
/// Requires: volume > 0. Cost: linear in the region's interfaces and in what is bone nearby.
[[nodiscard]] std::vector<Bolus> make_boluses(const CompiledJoint& joint, RegionId region,
                                              const Vec3& tip, double volume,
                                              const FibreField& fibres = {});

}  // namespace artus
