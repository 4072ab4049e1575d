// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// A surface to be drawn: a colour (blue, green, red) for each triangle.
struct ColouredMesh {
  SurfaceMesh mesh;
  std::vector<cv::Vec3b> colours;  ///< (n_triangles)
};

/// From where a picture is taken: unit vectors of the joint frame, without perspective.
struct MeshView {
  std::string name;  ///< "from the front"
  Vec3 right = Vec3::UnitX();
  Vec3 up = Vec3::UnitZ();
};

/// Of a page: what is looked at, and what is beside others.
[[nodiscard]] inline cv::Size large_picture() {
  return {520, 460};
}
[[nodiscard]] inline cv::Size small_picture() {
  return {300, 240};
}

/// The two views of a joint file's frame: from the front, and from its outer side (the right one
/// where it has no side). Letters of `axes` as in the joint file.
[[nodiscard]] std::vector<MeshView> picture_views(const std::string& axes, const std::string& side);

/// The interfaces around one region, seen from outside; its own triangles alone, compact.
[[nodiscard]] SurfaceMesh region_surface(const CompiledJoint& joint, RegionId region);

/// One colour for all triangles of a surface. Triangles with indices out of range or corners that
/// are not finite are left out.
[[nodiscard]] ColouredMesh coloured(const SurfaceMesh& mesh, const cv::Vec3b& colour);

/// The surfaces, lit from the viewer, filling a picture of `size` on white with a bar of 10 mm, and
/// a red ring around each of `marks` (m, also where it lies behind something).
/// Cost: linear in triangles and pixels.
[[nodiscard]] cv::Mat draw_meshes(std::span<const ColouredMesh> meshes, const MeshView& view,
                                  cv::Size size, std::span<const Vec3> marks = {});

/// A colour for a distance: green at 0, yellow at half of `worst`, red from `worst` on.
[[nodiscard]] cv::Vec3b distance_colour(double distance, double worst);

}  // namespace artus
