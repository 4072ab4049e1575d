// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/compile_surfaces.h"

#include <array>
#include <cstdio>
#include <utility>

#include <tbb/parallel_for.h>

#include "artus/anatomy/compile/compiler_version.h"
#include "artus/anatomy/surfaces/defects.h"
#include "artus/anatomy/surfaces/surface_io.h"
#include "artus/core/byte_stream.h"
#include "artus/core/text_file.h"
#include "artus/core/units.h"

namespace artus {
namespace {

/// Refuses what is too small or too large for a part of a body: a wrong unit.
Result<void> check_size(const SurfaceMesh& mesh) {
  DefectOptions options;
  options.self_intersections = false;
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles)
    for (const auto v : t)
      if (v < mesh.vertices.size() && mesh.vertices[v].allFinite()) box.extend(mesh.vertices[v]);
  const double size = box.isEmpty() ? options.smallest : box.diagonal().norm();
  if (size >= options.smallest && size <= options.largest) return {};
  std::array<char, 160> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(),
                                  "%.4g mm from corner to corner is no part of a body; give the "
                                  "unit of its file (units = \"m\", \"cm\" or \"mm\")",
                                  size / kMillimetre));
  return fail(ErrorCode::defective, text.data());
}

/// What repairing made of a surface file.
struct RepairedSurface {
  SurfaceMesh mesh;
  std::vector<std::string> repairs;  ///< in words
};

/// Over the file and all that its entry asks for; what cannot be read is told where it is read.
ContentDigest digest_of(const JointFile& file, const SurfaceFile& surface) {
  ContentDigest digest(kCompilerVersion);
  if (const auto bytes = read_bytes(file.surface_folder / surface.file)) digest.add(*bytes);
  digest.add(std::filesystem::path(surface.file).extension().string());
  digest.add_value(surface.unit);
  digest.add_value(surface.has_own_unit);
  digest.add(surface.repair);
  digest.add_value(surface.thicken);
  return digest;
}

std::string to_bytes(const RepairedSurface& repaired) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(repaired.repairs.size()));
  for (const std::string& repair : repaired.repairs) out.put(std::string_view(repair));
  out.put_array(repaired.mesh.vertices);
  out.put_array(repaired.mesh.triangles);
  return out.bytes();
}

std::optional<RepairedSurface> read_repaired(const std::optional<std::string>& bytes) {
  if (!bytes) return std::nullopt;
  ByteReader in(*bytes);
  RepairedSurface repaired;
  const std::uint32_t n = in.get_count(sizeof(std::uint32_t));
  for (std::uint32_t i = 0; i < n; ++i) repaired.repairs.push_back(in.get_text());
  repaired.mesh.vertices = in.get_array<Vec3>();
  repaired.mesh.triangles = in.get_array<Triangle>();
  if (!in.ok() || !in.at_end()) return std::nullopt;
  return repaired;
}

}  // namespace

Result<PreparedSurface> prepare_surface(const JointFile& file, const SurfaceFile& surface,
                                        StructureReport& report, const KeptParts& parts) {
  const ContentDigest digest = parts.keeps() ? digest_of(file, surface) : ContentDigest(0);
  std::optional<RepairedSurface> repaired = read_repaired(parts.find(digest));
  if (!repaired) {
    Result<SurfaceMesh> mesh = read_surface(file.surface_folder / surface.file, surface.unit);
    ARTUS_TRY(mesh);
    Result<RepairOutcome> outcome = repair_as_declared(*mesh, surface);
    ARTUS_TRY(outcome);
    repaired.emplace();
    repaired->mesh = std::move(outcome->mesh);
    for (const RepairAction& action : outcome->actions) repaired->repairs.push_back(action.message);
    if (parts.keeps()) parts.keep(digest, to_bytes(*repaired));
  }
  report.repairs = std::move(repaired->repairs);
  PreparedSurface prepared;
  prepared.mesh = std::move(repaired->mesh);
  report.surface_volume = signed_volume(prepared.mesh);
  const double area = surface_area(prepared.mesh);
  if (!(report.surface_volume > 0 && area > 0)) {
    return fail(ErrorCode::defective, "it encloses no volume", report.name);
  }
  prepared.thickness = 2 * report.surface_volume / area;
  prepared.tree = DistanceTree(prepared.mesh);
  return prepared;
}

Result<RepairOutcome> repair_as_declared(const SurfaceMesh& mesh, const SurfaceFile& surface) {
  if (!surface.has_own_unit) ARTUS_TRY(check_size(mesh));
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
                                          std::vector<StructureReport>& reports,
                                          const KeptParts& parts) {
  PreparedSurfaces prepared;
  StructureReport body_report;
  body_report.name = "body";
  Result<PreparedSurface> body =
      prepare_surface(file, std::get<SurfaceFile>(file.body.shape), body_report, parts);
  ARTUS_TRY(body);
  prepared.body = std::move(*body);
  prepared.structures.resize(file.structures.size());
  std::vector<std::optional<Error>> errors(file.structures.size());
  tbb::parallel_for(std::size_t{0}, file.structures.size(), [&](std::size_t i) {
    const auto* surface = std::get_if<SurfaceFile>(&file.structures[i].shape);
    if (surface == nullptr) return;
    Result<PreparedSurface> result = prepare_surface(file, *surface, reports[i], parts);
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
