// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>

#include "artus/core/geometry.h"

namespace artus {

/// A solid as a function: negative inside, positive outside, near the surface about the distance
/// to it in metres. Fields are values; the functions below compose them.
using Field = std::function<double(const Vec3&)>;

/// A ball about `centre`. Exact distance.
[[nodiscard]] Field make_ball(const Vec3& centre, double radius);

/// An ellipsoid with the given half axes along the columns of `axes` (a rotation). Distance to
/// first order.
[[nodiscard]] Field make_ellipsoid(const Vec3& centre, const Vec3& half_axes,
                                   const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

/// A cushion that lies along the surface of `side`, its middle surface `height` outside of it: an
/// ellipsoid of the half axes along the first two columns of `axes` (a rotation) and across that
/// surface, thickest at `centre` (a point at about that height) and thinning out to nothing at its
/// rim, the sooner the more the surface bends back from the third column. Distance to first order.
[[nodiscard]] Field make_cushion(Field side, double height, const Vec3& centre,
                                 const Vec3& half_axes, const Eigen::Matrix3d& axes);

/// What lies on the side of the plane through `point` that `outward` does not point to. Exact.
[[nodiscard]] Field make_half_space(const Vec3& point, const Vec3& outward);

/// The solid grown by `distance` (shrunk when negative).
[[nodiscard]] Field grow(Field field, double distance);

/// Both solids; within `blend` metres of each other their surfaces flow together (0: sharp).
[[nodiscard]] Field unite(Field a, Field b, double blend);

/// What both solids share, its edges rounded over `blend` metres.
[[nodiscard]] Field intersect(Field a, Field b, double blend);

/// `a` without `b`, its edges rounded over `blend` metres.
[[nodiscard]] Field subtract(Field a, Field b, double blend);

}  // namespace artus
