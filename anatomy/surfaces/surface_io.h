// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// The surface file formats artus reads and writes. STL is written binary, PLY binary little
/// endian, OFF and OBJ as text.
enum class SurfaceFormat { stl, ply, obj, off };

/// Reads a surface file; the format is taken from the content first and from the extension only
/// where the content leaves it open (a binary STL whose header starts with "solid" is still
/// binary). Coordinates are multiplied by `unit` (m per unit of the file). Polygons become fans of
/// triangles; the vertices of an STL are welded where they are equal. Coordinates that are not
/// finite are kept: find_defects names them.
/// Errors: not_found, unreadable, unsupported (glTF, 4OFF, unknown), malformed (with file:line or
/// byte), corrupt (a header that promises more than the file holds; refused before allocating).
/// Requires: unit > 0. Cost: linear; memory a small multiple of the file's size.
[[nodiscard]] Result<SurfaceMesh> read_surface(const std::filesystem::path& file, double unit);

/// The same from memory: `bytes` is the content, `name` stands in messages and lends its extension.
[[nodiscard]] Result<SurfaceMesh> parse_surface(std::string_view bytes, const std::string& name,
                                                double unit);

/// Writes `mesh` in the format of the extension (.stl, .ply, .obj, .off), metres divided by
/// `unit`. PLY, OFF and OBJ keep every bit of a double; STL rounds to float.
/// Errors: unsupported (extension), unreadable (cannot be written).
/// Requires: unit > 0; indices in range.
[[nodiscard]] Result<void> write_surface(const SurfaceMesh& mesh, const std::filesystem::path& file,
                                         double unit);

}  // namespace artus
