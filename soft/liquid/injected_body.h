// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/liquid.h"
#include "artus/detail/soft/liquid/opened_spaces.h"

namespace artus {

/// An ellipsoid of liquid that parts tissue.
struct Bolus {
  RegionId region = kFirstRegion;                      ///< that it lies in
  Vec3 centre = Vec3::Zero();                          ///< m, frame J, before those opened earlier
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< unit, in columns
  Vec3 proportion = Vec3::Ones();                      ///< of the semi-axes
  double volume = 0;                                   ///< m^3
  double ragged = 0;         ///< of its outline: 0.3 makes radii differ by a fifth; 0: smooth
  std::uint64_t number = 0;  ///< that its outline is drawn by

  /// m, its semi-axes where there is no bone.
  [[nodiscard]] Vec3 semi_axes() const;
};

/// What a volume that comes in at `tip` opens in a region, in the order of opening, the one around
/// the tip last. Muscle: streaks along the fibres between its fascicles, 10 : 5 : 0.7 mm, 0.15 ml
/// each and 2 mm apart. Tendon and what else has fibres: clefts between fibrils that stay, 9 : 6 :
/// 0.4 mm, 0.09 ml each and 1 mm apart, half of a length 15 mm at most. Both are staggered along
/// the fibres, flat toward the skin, lie in the region alone and grow where there is no room for
/// more. Nerve: one spindle of 8 : 3 : 0.5; fat: one lens of 4 : 4 : 1, flat toward what is
/// nearest, skin or bone; at bone it lies on it, the tip in it. assumed: all of it.
/// Requires: volume > 0. Cost: linear in the region's interfaces.
[[nodiscard]] std::vector<Bolus> make_boluses(const CompiledJoint& joint, RegionId region,
                                              const Vec3& tip, double volume);

/// m^3 that part a tissue without fibres at `tip` until what lies there is as thick as the layer
/// itself, and at least 0.05 ml; infinite for nerves and what has fibres, and where the layer is
/// far from the tip. Cost: linear in the region's interfaces.
[[nodiscard]] double room_at(const CompiledJoint& joint, RegionId region, const Vec3& tip);

/// The joint with the boluses as one more region, "injected", of `liquid`. One after another
/// pushes all around it aside as BolusOpening says: bones stay, to the last bit. Interfaces beside
/// it are cut finer (new vertices after the joint's), so that they follow that map. Their polyhedra
/// hold the volume to 1e-15 m^3. It has interfaces alone, no tetrahedra. Requires: volumes > 0,
/// fewer than 65535 regions.
[[nodiscard]] CompiledJoint with_boluses(const CompiledJoint& joint, std::vector<Bolus> boluses,
                                         const Liquid& liquid);

/// One place and what was put there.
struct Injected {
  std::string region;       ///< name
  double volume = 0;        ///< m^3
  bool cavity = false;      ///< a space that opens; otherwise tissue that parts
  Vec3 tip = Vec3::Zero();  ///< m, frame J, where it came in; of tissue, inside the region
  double pressure = 0;      ///< Pa of the liquid there when nothing presses; at least 500 is taken
  double more = 1;          ///< times what is drawn of it that is put in
};
/// Pa that presses on a material point (rest, m, frame J) from outside.
using StressAt = std::function<double(const Vec3&)>;

/// All of them: tissue first, then spaces, each whole (all regions of the space that a place is in
/// become of `liquid`), squeezed by `stress`, where one is given. What a space cannot take goes
/// where with_overflow says. What is less than 1 mm^3 is not drawn, nor what went outside.
/// `spaces`: of the joint, or of one with the same surfaces. Cost: a tenth of a second for a place,
/// and for a space that was not opened before what OpenedSpace says.
[[nodiscard]] CompiledJoint with_injected(const CompiledJoint& joint,
                                          const std::vector<Injected>& places, const Liquid& liquid,
                                          const StressAt& stress, const OpenedSpaces& spaces);
/// The same for once.
[[nodiscard]] CompiledJoint with_injected(const CompiledJoint& joint,
                                          const std::vector<Injected>& places, const Liquid& liquid,
                                          const StressAt& stress = {});

}  // namespace artus
