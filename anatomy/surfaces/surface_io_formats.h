// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

// One parser per format, in the file's own units. `name` stands in messages. Each refuses a header
// that promises more than `bytes` can hold before it allocates. Use read_surface from outside.

[[nodiscard]] bool is_binary_stl(std::string_view bytes) noexcept;
[[nodiscard]] Result<SurfaceMesh> parse_stl_binary(std::string_view bytes, const std::string& name);
[[nodiscard]] Result<SurfaceMesh> parse_stl_ascii(std::string_view bytes, const std::string& name);
[[nodiscard]] Result<SurfaceMesh> parse_ply(std::string_view bytes, const std::string& name);
[[nodiscard]] Result<SurfaceMesh> parse_obj(std::string_view bytes, const std::string& name);
[[nodiscard]] Result<SurfaceMesh> parse_off(std::string_view bytes, const std::string& name);

/// The mesh as the bytes of a file; coordinates are divided by `unit`.
[[nodiscard]] std::string format_stl(const SurfaceMesh& mesh, double unit);
[[nodiscard]] std::string format_ply(const SurfaceMesh& mesh, double unit);
[[nodiscard]] std::string format_obj(const SurfaceMesh& mesh, double unit);
[[nodiscard]] std::string format_off(const SurfaceMesh& mesh, double unit);

}  // namespace artus
