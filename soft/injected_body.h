// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/anatomy/body/compiled_joint.h"
#include "artus/anatomy/body/liquid.h"
#include "artus/soft/inflated_space.h"

namespace artus {

/// An ellipsoid of liquid that parts tissue.
struct Bolus {
  RegionId region = kFirstRegion;                      ///< that it lies in
  Vec3 centre = Vec3::Zero();                          ///< m, frame J
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< unit, in columns
  Vec3 proportion = Vec3::Ones();                      ///< of the semi-axes
  double volume = 0;                                   ///< m^3
};

/// What a bolus in a region looks like: a lens of 3 : 2 : 0.6 along the fibres of muscle, a
/// split of 8 : 3 : 0.5 in tendon and the like, 4 : 4 : 1 in the plane of fat, all flat toward the
/// skin; assumed: the proportions.
[[nodiscard]] Bolus make_bolus(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                               double volume);

/// The joint with the bolus as a region of its own, "injected", of `liquid`. All around is pushed
/// aside by the map rho -> (rho^3 + 1)^(1/3) of the ellipsoid's own radius, which keeps every
/// volume; bones, too, move by what that is at their place. Interfaces beside it are cut finer (new
/// vertices after the joint's), so that they follow that map. The new region's polyhedron holds the
/// volume to rounding. It has interfaces alone, no tetrahedra. Requires: volume > 0, fewer than
/// 65535 regions.
[[nodiscard]] CompiledJoint with_bolus(const CompiledJoint& joint, const Bolus& bolus,
                                       const Liquid& liquid);

/// The joint with `volume` m^3 more in `region`, which from then on is of `liquid`.
[[nodiscard]] CompiledJoint with_filled_space(const CompiledJoint& joint, RegionId region,
                                              const Vec3& tip, double volume, const Liquid& liquid);

/// One place and what was put there.
struct Injected {
  std::string region;       ///< name
  double volume = 0;        ///< m^3
  bool cavity = false;      ///< a space that opens; otherwise tissue that parts
  Vec3 tip = Vec3::Zero();  ///< m, frame J, where it came in; of tissue, inside the region
};
/// All of them, one after another. What is less than 1 mm^3 is not drawn, nor what went outside.
[[nodiscard]] CompiledJoint with_injected(const CompiledJoint& joint,
                                          const std::vector<Injected>& places,
                                          const Liquid& liquid);

}  // namespace artus
