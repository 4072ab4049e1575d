// SPDX-License-Identifier: AGPL-3.0-or-later
#include "anatomy/compile_surfaces.h"

#include <cmath>

#include "anatomy/surface_io.h"

namespace artus {
namespace {

Result<PreparedSurface> prepare(const JointFile& file, const SurfaceFile& surface,
                                StructureReport& report) {
  Result<SurfaceMesh> mesh = read_surface(file.surface_folder / surface.file, surface.unit);
  if (!mesh) return tl::unexpected(mesh.error());
  PreparedSurface prepared;
  prepared.mesh = std::move(*mesh);
  if (signed_volume(prepared.mesh) < 0) {
    for (Triangle& t : prepared.mesh.triangles) std::swap(t[1], t[2]);
    report.repairs.emplace_back("turned inside out");
  }
  report.surface_volume = signed_volume(prepared.mesh);
  const double area = surface_area(prepared.mesh);
  prepared.thickness = area > 0 ? 2 * report.surface_volume / area : 0;
  prepared.tree = DistanceTree(prepared.mesh);
  if (!(prepared.thickness > 0)) {
    return fail(ErrorCode::defective, "it encloses no volume", report.name);
  }
  return prepared;
}

}  // namespace

Result<PreparedSurfaces> prepare_surfaces(const JointFile& file,
                                          std::vector<StructureReport>& reports) {
  PreparedSurfaces prepared;
  StructureReport body_report;
  body_report.name = "body";
  Result<PreparedSurface> body = prepare(file, std::get<SurfaceFile>(file.body.shape), body_report);
  if (!body) return tl::unexpected(body.error());
  prepared.body = std::move(*body);
  prepared.structures.resize(file.structures.size());
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    const auto* surface = std::get_if<SurfaceFile>(&file.structures[i].shape);
    if (surface == nullptr) continue;
    Result<PreparedSurface> result = prepare(file, *surface, reports[i]);
    if (result) {
      prepared.structures[i] = std::move(*result);
    } else if (result.error().code == ErrorCode::defective) {
      reports[i].refused = result.error().message;
    } else {
      return tl::unexpected(result.error());
    }
  }
  return prepared;
}

}  // namespace artus
