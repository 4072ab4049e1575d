// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <map>
#include <string>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/compile/labels/distance_field.h"

namespace artus {

/// What constructs are made from: the fields of the structures they name; "" is the body.
using NamedFields = std::map<std::string, const DistanceField*>;

/// What a structure's field must tell so that constructs can be made from it.
struct FarNeed {
  double band = 0;  ///< m of distance
  Box box;          ///< where; without limit unless the constructs have one
};

/// The needs of all constructs, by the name of the structure; "" is the body. Structures that no
/// construct names are absent.
[[nodiscard]] std::map<std::string, FarNeed> find_far_needs(const JointFile& joint);

/// The construct's field, sampled in `sampling.box` (cut to where the construct can be).
/// Shell: within `thickness` inside the surface.
/// Cap: on the bone within min(thickness, half the gap to what it faces), thinning to half of that
/// at the rim, where the gap reaches `within`.
/// Gap: as make_gap_field makes it where there is nothing else.
/// End: what of the structure lies within `within` of the insertion.
/// Requires: `fields` holds all structures the construct names.
[[nodiscard]] DistanceField make_construct_field(const Structure& structure,
                                                 const NamedFields& fields,
                                                 const FieldSampling& sampling);

/// The middle of a muscle's contact with a bone: of its vertices near the one deepest in the bone.
/// For an EndConstruct without an insertion.
[[nodiscard]] Vec3 find_insertion(const SurfaceMesh& muscle, const DistanceField& bone);

}  // namespace artus
