// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/compile_surfaces.h"

#include <utility>

#include <tbb/parallel_for.h>

#include "artus/anatomy/surfaces/surface_io.h"

namespace artus {
namespace {

Result<PreparedSurface> prepare(const JointFile& file, const SurfaceFile& surface,
                                StructureReport& report) {
  Result<SurfaceMesh> mesh = read_surface(file.surface_folder / surface.file, surface.unit);
  if (!mesh) return tl::unexpected(mesh.error());
  Result<RepairOutcome> outcome = repair_as_declared(*mesh, surface);
  if (!outcome) return tl::unexpected(outcome.error());
  for (const RepairAction& action : outcome->actions) report.repairs.push_back(action.message);
  PreparedSurface prepared;
  prepared.mesh = std::move(outcome->mesh);
  report.surface_volume = signed_volume(prepared.mesh);
  const double area = surface_area(prepared.mesh);
  if (!(report.surface_volume > 0 && area > 0)) {
    return fail(ErrorCode::defective, "it encloses no volume", report.name);
  }
  prepared.thickness = 2 * report.surface_volume / area;
  prepared.tree = DistanceTree(prepared.mesh);
  return prepared;
}

}  // namespace

Result<RepairOutcome> repair_as_declared(const SurfaceMesh& mesh, const SurfaceFile& surface) {
  if (surface.repair == "none") {
    RepairOutcome untouched;
    untouched.mesh = mesh;
    untouched.volume = signed_volume(mesh);
    return untouched;
  }
  RepairOptions options;
  options.thicken = surface.thicken;
  if (surface.repair == "wrap") options.wrap = WrapPolicy::always;
  return repair_surface(mesh, options);
}

Result<PreparedSurfaces> prepare_surfaces(const JointFile& file,
                                          std::vector<StructureReport>& reports) {
  PreparedSurfaces prepared;
  StructureReport body_report;
  body_report.name = "body";
  Result<PreparedSurface> body = prepare(file, std::get<SurfaceFile>(file.body.shape), body_report);
  if (!body) return tl::unexpected(body.error());
  prepared.body = std::move(*body);
  prepared.structures.resize(file.structures.size());
  std::vector<std::optional<Error>> errors(file.structures.size());
  tbb::parallel_for(std::size_t{0}, file.structures.size(), [&](std::size_t i) {
    const auto* surface = std::get_if<SurfaceFile>(&file.structures[i].shape);
    if (surface == nullptr) return;
    Result<PreparedSurface> result = prepare(file, *surface, reports[i]);
    if (result) {
      prepared.structures[i] = std::move(*result);
    } else {
      errors[i] = result.error();
    }
  });
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i]) continue;
    if (errors[i]->code != ErrorCode::defective) return tl::unexpected(*errors[i]);
    reports[i].refused = errors[i]->message;
  }
  return prepared;
}

}  // namespace artus
