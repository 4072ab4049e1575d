// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/anatomy/body/compiled_joint.h"
#include "artus/anatomy/body/liquid.h"
#include "artus/soft/bolus.h"

namespace artus {

/// The joint with the boluses as one more region, "injected", of `liquid`. One after another
/// pushes what is around it aside as Cleft says: along its own last axis, so that no wall passes
/// another, by as much as its volume, and no bone. Interfaces beside it are cut finer (new vertices
/// after the joint's), so that they follow. The polyhedron of each holds its volume to rounding,
/// the earlier ones until the later push them, to 1 %. It has interfaces alone, no tetrahedra.
/// Requires: volumes > 0, fewer than 65535 regions.
[[nodiscard]] CompiledJoint with_boluses(const CompiledJoint& joint,
                                         const std::vector<Bolus>& boluses, const Liquid& liquid);

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
/// `fibres`: of the joint at rest; empty: each region's one axis.
[[nodiscard]] CompiledJoint with_injected(const CompiledJoint& joint,
                                          const std::vector<Injected>& places, const Liquid& liquid,
                                          const FibreField& fibres = {});

}  // namespace artus
