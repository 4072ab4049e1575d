// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "artus/detail/anatomy/surfaces/surface_io_formats.h"

namespace artus {

/// What every reader promises of every file: indices in range, and memory bounded by the file.
inline void check_promises(const Result<SurfaceMesh>& mesh, std::size_t n_bytes) {
  if (!mesh) {
    if (mesh.error().message.empty() || mesh.error().where.empty()) std::abort();
    return;
  }
  if (mesh->triangles.size() > n_bytes || mesh->vertices.size() > n_bytes) std::abort();
  for (const auto& t : mesh->triangles)
    for (const auto v : t)
      if (v >= mesh->vertices.size()) std::abort();
}

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace artus
