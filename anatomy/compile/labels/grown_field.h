// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/compile/labels/distance_field.h"

namespace artus {

/// What lies within `grow` outside of a surface, or (negative) deeper than that inside. Requires:
/// `field` tells distances as far as `grow` and the sampling's band.
[[nodiscard]] DistanceField offset_field(const DistanceField& field, double grow,
                                         const FieldSampling& sampling);

/// What a structure covers when it is moved along the skin's outward normal by 0 to `grow`, m: its
/// side that faces the skin moves, the other stays. Of a negative `grow` what stays covered by all
/// of these. `skin` is the body's field, `thickness` the structure's, m: its copies lie a quarter
/// of that apart. Requires: `field` tells distances as far as `grow`, `skin` as deep as the
/// structure lies. Cost: a query of `field` for each copy and sample.
[[nodiscard]] DistanceField swept_field(const DistanceField& field, const DistanceField& skin,
                                        double grow, double thickness,
                                        const FieldSampling& sampling);

}  // namespace artus
