// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/cells/cell_types.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/printed.h"

namespace artus {
namespace {

// Numbers, points and corners as vtkCellType.h has them.
constexpr std::array<CellType, 25> kVtk{{{1, CellShape::polygon, 1, 1},
                                         {2, CellShape::polygon, 0, 1},
                                         {3, CellShape::polygon, 2, 2},
                                         {4, CellShape::polygon, 0, 2},
                                         {5, CellShape::polygon, 3, 3},
                                         {7, CellShape::polygon, 0, 0},
                                         {9, CellShape::polygon, 4, 4},
                                         {10, CellShape::tetrahedron, 4, 4},
                                         {11, CellShape::hexahedron, 8, 8, true},
                                         {12, CellShape::hexahedron, 8, 8},
                                         {13, CellShape::wedge, 6, 6},
                                         {14, CellShape::pyramid, 5, 5},
                                         {21, CellShape::polygon, 3, 2},
                                         {22, CellShape::polygon, 6, 3},
                                         {23, CellShape::polygon, 8, 4},
                                         {24, CellShape::tetrahedron, 10, 4},
                                         {25, CellShape::hexahedron, 20, 8},
                                         {26, CellShape::wedge, 15, 6},
                                         {27, CellShape::pyramid, 13, 5},
                                         {29, CellShape::hexahedron, 27, 8},
                                         {68, CellShape::polygon, 0, 2},
                                         {69, CellShape::polygon, 0, 3},
                                         {71, CellShape::tetrahedron, 0, 4},
                                         {72, CellShape::hexahedron, 0, 8},
                                         {73, CellShape::wedge, 0, 6}}};
// As Gmsh's manual lists them.
constexpr std::array<CellType, 18> kGmsh{{{1, CellShape::polygon, 2, 2},
                                          {2, CellShape::polygon, 3, 3},
                                          {3, CellShape::polygon, 4, 4},
                                          {4, CellShape::tetrahedron, 4, 4},
                                          {5, CellShape::hexahedron, 8, 8},
                                          {6, CellShape::wedge, 6, 6},
                                          {7, CellShape::pyramid, 5, 5},
                                          {8, CellShape::polygon, 3, 2},
                                          {9, CellShape::polygon, 6, 3},
                                          {10, CellShape::polygon, 9, 4},
                                          {11, CellShape::tetrahedron, 10, 4},
                                          {12, CellShape::hexahedron, 27, 8},
                                          {13, CellShape::wedge, 18, 6},
                                          {14, CellShape::pyramid, 14, 5},
                                          {15, CellShape::polygon, 1, 1},
                                          {16, CellShape::polygon, 8, 4},
                                          {17, CellShape::hexahedron, 20, 8},
                                          {18, CellShape::wedge, 15, 6}}};

}  // namespace

std::span<const CellType> vtk_cell_types() noexcept {
  return kVtk;
}
std::span<const CellType> gmsh_cell_types() noexcept {
  return kGmsh;
}

std::optional<CellType> find_cell_type(std::span<const CellType> types, int number) {
  const auto at = std::find_if(types.begin(), types.end(),
                               [&](const CellType& type) { return type.number == number; });
  return at == types.end() ? std::nullopt : std::optional(*at);
}

Result<void> add_cell(VolumeMesh& mesh, const CellType& type, std::span<const double> points,
                      std::int64_t material, const std::string& where) {
  const bool is_short = points.size() < type.n_corners ||
                        (type.n_points > 0 && points.size() != type.n_points) ||
                        (type.n_corners == 0 && points.size() < 3);
  if (is_short)
    return fail(ErrorCode::malformed,
                printed("a cell of type %d has %zu points, which is not what such a cell has",
                        type.number, points.size()),
                where);
  if (type.n_corners == 1 || type.n_corners == 2) return {};
  const std::size_t n = type.n_corners > 0 ? type.n_corners : points.size();
  VolumeMesh::Cell cell;
  cell.shape = type.shape;
  cell.material = material;
  cell.first = static_cast<std::uint32_t>(mesh.corners.size());
  cell.n = static_cast<std::uint32_t>(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double v = points[k];
    if (!(v >= 0 && v < static_cast<double>(mesh.points.size()) && v == std::floor(v)))
      return fail(ErrorCode::malformed,
                  printed("a cell names point %.0f of %zu", v, mesh.points.size()), where);
    mesh.corners.push_back(static_cast<std::uint32_t>(v));
  }
  if (type.is_voxel) {
    std::swap(mesh.corners[cell.first + 2], mesh.corners[cell.first + 3]);
    std::swap(mesh.corners[cell.first + 6], mesh.corners[cell.first + 7]);
  }
  mesh.cells.push_back(cell);
  return {};
}

}  // namespace artus
