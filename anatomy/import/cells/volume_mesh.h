// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// What a cell of a mesh is; the corners are in VTK's order, of curved ones the corners alone.
enum class CellShape : std::uint8_t { polygon, tetrahedron, hexahedron, wedge, pyramid };

/// Corners of a shape; 0 for a polygon, which has any number.
[[nodiscard]] std::size_t corners_of(CellShape shape) noexcept;

/// A mesh of cells as programs of finite elements and ParaView have it. Coordinates are the file's.
struct VolumeMesh {
  struct Cell {
    CellShape shape = CellShape::polygon;
    std::int64_t material = 0;
    std::uint32_t first = 0;  ///< of `corners`
    std::uint32_t n = 0;
  };
  std::string format;
  std::vector<Vec3> points;
  std::vector<std::uint32_t> corners;
  std::vector<Cell> cells;
  std::map<std::int64_t, std::string> names;  ///< of materials; may be empty
  std::string material_by;                    ///< the array that says it; empty: there is none
  std::vector<std::string> notes;

  /// Whether it has cells with a volume; else it is a surface.
  [[nodiscard]] bool has_volume() const noexcept;
};

/// The surface around all cells of one material.
struct MaterialSurface {
  std::int64_t material = 0;
  std::string name;
  std::size_t n_cells = 0;
  SurfaceMesh mesh;  ///< of the file's coordinates, wound outward
};

/// Faces that a material does not share with itself, by material; quads are parted alike on both
/// sides. Errors: malformed (a face that three cells share). Cost: n log n.
[[nodiscard]] Result<std::vector<MaterialSurface>> find_boundaries(const VolumeMesh& mesh,
                                                                   const std::string& name);

/// The surface around all cells, or the polygons of a mesh that has no others.
[[nodiscard]] Result<SurfaceMesh> find_outer_boundary(const VolumeMesh& mesh,
                                                      const std::string& name);

/// VTK's XML files of unstructured grids and surfaces (.vtu, .vtp): arrays as text, base64 or raw,
/// as they are or compressed by zlib. The material is the array of whole numbers a cell that is
/// named so, or the only one. Errors: malformed, corrupt (cut off, more promised than there is),
/// unsupported (other kinds of data, other compressors), naming what to save instead.
[[nodiscard]] Result<VolumeMesh> parse_vtk_xml(std::string_view bytes, const std::string& name);

/// Gmsh's meshes of versions 2.2 and 4.1 as text. Materials are physical groups, else entities.
/// Errors: as parse_vtk_xml.
[[nodiscard]] Result<VolumeMesh> parse_gmsh(std::string_view bytes, const std::string& name);

}  // namespace artus
