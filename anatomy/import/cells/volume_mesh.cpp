// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/cells/volume_mesh.h"

#include <algorithm>
#include <array>
#include <span>

namespace artus {
namespace {

using Key = std::array<std::uint32_t, 4>;  // sorted corners; a triangle's first is 0 twice

constexpr std::uint32_t kNone = 0xffffffffU;

/// Sides of shapes by local corners; a triangle ends in -1.
using LocalFace = std::array<int, 4>;
constexpr std::array<LocalFace, 4> kTetrahedron{
    {{0, 1, 2, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 2, 3, -1}}};
constexpr std::array<LocalFace, 6> kHexahedron{
    {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
constexpr std::array<LocalFace, 5> kWedge{
    {{0, 1, 2, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
constexpr std::array<LocalFace, 5> kPyramid{
    {{0, 1, 2, 3}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};

std::span<const LocalFace> faces_of(CellShape shape) {
  switch (shape) {
    case CellShape::tetrahedron:
      return kTetrahedron;
    case CellShape::hexahedron:
      return kHexahedron;
    case CellShape::wedge:
      return kWedge;
    case CellShape::pyramid:
      return kPyramid;
    default:
      return {};
  }
}

/// A side of a cell.
struct Side {
  Key key{};
  std::uint32_t cell = 0;
  std::uint8_t face = 0;
};

std::vector<std::uint32_t> corners_of_side(const VolumeMesh& mesh, const Side& side) {
  const auto& cell = mesh.cells[side.cell];
  std::vector<std::uint32_t> corners;
  for (const int k : faces_of(cell.shape)[side.face])
    if (k >= 0) corners.push_back(mesh.corners[cell.first + static_cast<std::uint32_t>(k)]);
  return corners;
}

std::vector<Side> sides_of(const VolumeMesh& mesh) {
  std::vector<Side> sides;
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c)
    for (std::uint8_t f = 0; f < faces_of(mesh.cells[c].shape).size(); ++f) {
      Side side{{kNone, kNone, kNone, kNone}, c, f};
      const auto corners = corners_of_side(mesh, side);
      std::copy(corners.begin(), corners.end(), side.key.begin());
      std::sort(side.key.begin(), side.key.end());
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.key, a.cell, a.face) < std::tie(b.key, b.cell, b.face);
  });
  return sides;
}

/// A surface that is being gathered, with the mesh's points that it needs.
class Gathered {
 public:
  explicit Gathered(const VolumeMesh& mesh) : mesh_(mesh), to_(mesh.points.size(), kNone) {}

  /// A side, wound so that it looks away from its cell.
  void add(const Side& side) {
    std::vector<std::uint32_t> corners = corners_of_side(mesh_, side);
    const auto& cell = mesh_.cells[side.cell];
    const Vec3 inside = middle(std::span(mesh_.corners).subspan(cell.first, cell.n));
    const Vec3 centre = middle(corners);
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k)
      normal += (mesh_.points[corners[k]] - centre)
                    .cross(mesh_.points[corners[(k + 1) % corners.size()]] - centre);
    if (normal.dot(centre - inside) < 0) std::reverse(corners.begin(), corners.end());
    add_polygon(corners);
  }
  /// As a fan around its least corner, so that both sides of it are parted alike.
  void add_polygon(std::vector<std::uint32_t> corners) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      surface_.triangles.push_back(
          {vertex(corners[0]), vertex(corners[k]), vertex(corners[k + 1])});
  }
  SurfaceMesh take() { return std::move(surface_); }

 private:
  [[nodiscard]] Vec3 middle(std::span<const std::uint32_t> corners) const {
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t v : corners) sum += mesh_.points[v];
    return sum / static_cast<double>(corners.size());
  }
  std::uint32_t vertex(std::uint32_t point) {
    if (to_[point] == kNone) {
      to_[point] = static_cast<std::uint32_t>(surface_.vertices.size());
      surface_.vertices.push_back(mesh_.points[point]);
    }
    return to_[point];
  }

  const VolumeMesh& mesh_;
  std::vector<std::uint32_t> to_;
  SurfaceMesh surface_;
};

/// Calls `take` with each side that has no cell of the same kind behind it.
template <class Kind, class Take>
Result<void> for_boundary(const VolumeMesh& mesh, const std::vector<Side>& sides, Kind kind,
                          Take take, const std::string& name) {
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i;
    while (j < sides.size() && sides[j].key == sides[i].key) ++j;
    if (j - i > 2)
      return fail(ErrorCode::malformed,
                  "a face of it belongs to more than two cells; mesh it again", name);
    const bool is_inner =
        j - i == 2 && kind(mesh.cells[sides[i].cell]) == kind(mesh.cells[sides[i + 1].cell]);
    for (std::size_t k = i; k < j && !is_inner; ++k) take(sides[k]);
    i = j;
  }
  return {};
}

}  // namespace

std::size_t corners_of(CellShape shape) noexcept {
  switch (shape) {
    case CellShape::tetrahedron:
      return 4;
    case CellShape::hexahedron:
      return 8;
    case CellShape::wedge:
      return 6;
    case CellShape::pyramid:
      return 5;
    default:
      return 0;
  }
}

bool VolumeMesh::has_volume() const noexcept {
  return std::any_of(cells.begin(), cells.end(),
                     [](const Cell& cell) { return cell.shape != CellShape::polygon; });
}

Result<std::vector<MaterialSurface>> find_boundaries(const VolumeMesh& mesh,
                                                     const std::string& name) {
  std::map<std::int64_t, std::size_t> n_cells;
  for (const auto& cell : mesh.cells)
    if (cell.shape != CellShape::polygon) ++n_cells[cell.material];
  const std::vector<Side> sides = sides_of(mesh);
  std::map<std::int64_t, std::vector<Side>> of_material;
  ARTUS_TRY(for_boundary(
      mesh, sides, [](const VolumeMesh::Cell& cell) { return cell.material; },
      [&](const Side& side) { of_material[mesh.cells[side.cell].material].push_back(side); },
      name));
  std::vector<MaterialSurface> out;
  for (const auto& [material, own] : of_material) {
    Gathered gathered(mesh);
    for (const Side& side : own) gathered.add(side);
    const auto named = mesh.names.find(material);
    out.push_back({material, named == mesh.names.end() ? std::string() : named->second,
                   n_cells[material], gathered.take()});
  }
  return out;
}

Result<SurfaceMesh> find_outer_boundary(const VolumeMesh& mesh, const std::string& name) {
  Gathered gathered(mesh);
  if (!mesh.has_volume()) {
    for (const auto& cell : mesh.cells) {
      const auto corners = std::span(mesh.corners).subspan(cell.first, cell.n);
      gathered.add_polygon({corners.begin(), corners.end()});
    }
    return gathered.take();
  }
  ARTUS_TRY(for_boundary(
      mesh, sides_of(mesh), [](const VolumeMesh::Cell&) { return 0; },
      [&](const Side& side) { gathered.add(side); }, name));
  return gathered.take();
}

}  // namespace artus
