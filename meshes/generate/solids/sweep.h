// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include "artus/detail/meshes/generate/solids/field.h"

namespace artus {

/// A station of a round sweep: where its axis passes and how thick it is there, m.
struct TubeStation {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
};

/// A station of a flat sweep (a muscle, a tendon): half width across and half thickness along
/// `normal`, m.
struct RibbonStation {
  Vec3 centre = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double half_width = 0;
  double half_thickness = 0;
};

/// A round tube with rounded ends along the smooth curve through the stations (a bone's shaft, a
/// vessel). Requires: at least two stations. Cost of a value: linear in stations.
[[nodiscard]] Field make_tube(const std::vector<TubeStation>& stations);

/// A closed round ring of constant radius through the points. Requires: at least three points.
[[nodiscard]] Field make_ring(const std::vector<Vec3>& points, double radius);

/// A tube of elliptical section with rounded ends along the smooth curve through the stations.
/// `power` makes the section a superellipse: 2 an ellipse, more a band that keeps its thickness
/// toward its edges. Requires: at least two stations; normals not along the curve; power >= 2.
[[nodiscard]] Field make_ribbon(const std::vector<RibbonStation>& stations, double power = 2);

/// A flat plate with rounded rim: all points within `radius` of one of the triangles.
[[nodiscard]] Field make_plate(const std::vector<std::array<Vec3, 3>>& triangles, double radius);

}  // namespace artus
