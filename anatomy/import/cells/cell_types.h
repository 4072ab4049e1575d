// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>

#include "artus/detail/anatomy/import/cells/volume_mesh.h"

namespace artus {

/// What a number of a format stands for.
struct CellType {
  int number = 0;
  CellShape shape = CellShape::polygon;
  std::uint32_t n_points = 0;   ///< in the file; 0: as many as it says
  std::uint32_t n_corners = 0;  ///< the first of them; 0: all; 1 and 2: points and lines, left out
  bool is_voxel = false;        ///< VTK's voxel: its corners run in rows
};

[[nodiscard]] std::span<const CellType> vtk_cell_types() noexcept;
[[nodiscard]] std::span<const CellType> gmsh_cell_types() noexcept;

/// nullopt: the number is not known.
[[nodiscard]] std::optional<CellType> find_cell_type(std::span<const CellType> types, int number);

/// Adds a cell of `points`. Errors: malformed (a point that is not there, another number of
/// points), naming `where`.
[[nodiscard]] Result<void> add_cell(VolumeMesh& mesh, const CellType& type,
                                    std::span<const double> points, std::int64_t material,
                                    const std::string& where);

}  // namespace artus
