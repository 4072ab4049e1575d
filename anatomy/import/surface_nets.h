// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/anatomy/import/volumes/image_volume.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// A face between two voxels of different labels: four vertices round it, counter-clockwise seen
/// from `above`, which lies on the side of the larger index.
struct NetFace {
  std::array<std::uint32_t, 4> vertices{};
  std::uint16_t below = 0, above = 0;  ///< labels of the two voxels; 0: nothing
  std::uint32_t voxel = 0;             ///< the lower voxel, numbered with a rim of one around
  std::uint8_t axis = 0;               ///< along which the two voxels lie
  bool cut = false;                    ///< one of them lies outside of the volume
};

/// The surface between all labels of a volume: one vertex in each cell of eight voxel centres that
/// are not all of one label. Labels that touch share their vertices.
struct SurfaceNet {
  std::array<std::size_t, 3> size{0, 0, 0};        ///< of the volume
  std::vector<Vec3> points;                        ///< (n) indices: voxel centres at whole numbers
  std::vector<std::array<std::int32_t, 3>> cells;  ///< (n) lower voxel of the cell; -1: the rim
  std::vector<std::array<std::uint32_t, 6>> neighbours;  ///< (n) -x +x -y +y -z +z; kNoVertex
  std::vector<NetFace> faces;
};
inline constexpr std::uint32_t kNoVertex = 0xffffffffU;

/// The net with its vertices in the middles of their cells. Beyond the volume there is nothing.
/// Where three labels meet (the border of the volume counts as one), a vertex has its neighbours
/// along that line alone.
/// Requires: labels as many as size says. Cost: linear, about 0.5 s for 24 million voxels.
/// Source: [Frisken2022], section 3.
[[nodiscard]] SurfaceNet make_surface_net(std::span<const std::uint16_t> labels,
                                          const std::array<std::size_t, 3>& size);

/// Moves each vertex half way to the mean of its neighbours, `steps` times, by at most 0.45 voxel
/// along each axis from the middle of its cell, so that no voxel centre changes its label. What
/// lies on the volume's border stays in it. Source: [Frisken2022], section 3.3.
void smooth(SurfaceNet& net, int steps = 20);

/// What fit_volumes did to a label.
struct LabelVolumes {
  double counted = 0;   ///< m^3, its voxels
  double smoothed = 0;  ///< m^3, enclosed before
  double fitted = 0;    ///< m^3, enclosed after
};

/// Moves the surfaces along their normals so that each label encloses the volume of its voxels,
/// which smoothing shrinks: the offset between labels a and b is p_a - p_b, with p from
/// sum_b A_ab (p_a - p_b) = dV_a and 0 for nothing; twice. Labels of fewer than `least` voxels are
/// left as they are, and no vertex leaves its cell. `counts` are the voxels of each label, from 1
/// on. Returns one entry for each of these. Cost: linear, and cubic in the labels.
std::vector<LabelVolumes> fit_volumes(SurfaceNet& net, std::span<const std::size_t> counts,
                                      const IndexFrame& X_LI, std::size_t least = 1000);

/// A label's surface.
struct LabelSurface {
  SurfaceMesh mesh;                  ///< closed, wound outward, LPS m
  std::vector<std::uint8_t> is_cut;  ///< (n_triangles) 1: on the border of the volume
  std::size_t n_split = 0;           ///< edges of more than two faces that were taken apart
};

/// The closed surface of each label from 1 to `n_labels`. Labels that touch have the same triangles
/// there, bit by bit. Where a label meets itself in an edge or a corner the two sides get vertices
/// of their own at one place, so that every surface is a manifold. Labels above are passed over.
[[nodiscard]] std::vector<LabelSurface> make_label_surfaces(const SurfaceNet& net,
                                                            std::size_t n_labels,
                                                            const IndexFrame& X_LI);

/// The surface of all that has a label, wound outward; the same triangles as the labels' own.
[[nodiscard]] LabelSurface make_outer_surface(const SurfaceNet& net, const IndexFrame& X_LI);

/// The two triangles of a face, as corners of its four vertices, cut along the shorter diagonal.
[[nodiscard]] std::array<std::array<std::uint8_t, 3>, 2> triangles_of(const NetFace& face,
                                                                      std::span<const Vec3> places);

/// The points of the net in LPS, m.
[[nodiscard]] std::vector<Vec3> places_of(const SurfaceNet& net, const IndexFrame& X_LI);

}  // namespace artus
