// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/import_cells.h"

#include <algorithm>
#include <filesystem>

#include "artus/detail/anatomy/import/label_volume.h"
#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// Gives materials the names that the user says. Errors: invalid, with what has none.
Result<void> name_materials(std::vector<MaterialSurface>& surfaces, const ImportOptions& options,
                            const std::string& by, const std::string& file) {
  std::string unnamed;
  for (MaterialSurface& s : surfaces) {
    for (const NamedLabel& label : options.names.labels)
      if (label.value == static_cast<double>(s.material)) s.name = label.name;
    if (!s.name.empty()) continue;
    if (surfaces.size() == 1)
      s.name = std::filesystem::path(file).stem().string();
    else
      unnamed += printed("%s%lld (%zu cells)", unnamed.empty() ? "" : ", ",
                         static_cast<long long>(s.material), s.n_cells);
  }
  if (unnamed.empty()) return {};
  return fail(ErrorCode::invalid,
              "the mesh does not name its materials ('" + by + "'): " + unnamed +
                  ". Write a file names.toml with, for each, the lines '[[label]]', 'value = 1', "
                  "'name = \"femur\"', and give it with --labels names.toml",
              file);
}

SurfaceMesh in_metres(SurfaceMesh mesh, double unit) {
  for (Vec3& p : mesh.vertices) p *= unit;
  return mesh;
}

}  // namespace

Result<std::optional<VolumeMesh>> read_cells(std::string_view bytes, const std::string& name) {
  const SourceKind kind = kind_of_source(bytes, name);
  if (kind != SourceKind::vtk_xml && kind != SourceKind::gmsh) return std::nullopt;
  auto mesh = kind == SourceKind::gmsh ? parse_gmsh(bytes, name) : parse_vtk_xml(bytes, name);
  ARTUS_TRY(mesh);
  return std::optional(std::move(*mesh));
}

Result<ImportedJoint> import_cells(const VolumeMesh& mesh, const ImportOptions& options,
                                   const std::string& file, const Progress& progress) {
  if (!options.surface_unit)
    return fail(ErrorCode::invalid,
                printed("it is a volume mesh (%s, %zu cells) and says no unit; give it, --units mm "
                        "(cm, m), and the boundary of each material is taken",
                        mesh.format.c_str(), mesh.cells.size()),
                file);
  auto surfaces = find_boundaries(mesh, file);
  ARTUS_TRY(surfaces);
  ARTUS_TRY(name_materials(*surfaces, options, mesh.material_by, file));
  const auto bundled = read_bundled_structure_names();
  ARTUS_TRY(bundled);
  std::vector<ScenePart> parts;
  std::vector<std::string> fat;  // what no structure claims
  bool is_outlined = false;      // a material reaches the skin
  for (MaterialSurface& s : *surfaces) {
    const auto known = find_tissue(options.names, *bundled, s.name, {});
    const std::string tissue = known ? known->tissue : std::string();
    is_outlined = is_outlined || tissue == kBodyOutline || tissue == "skin" || tissue == "fat";
    if (tissue == "fat")
      fat.push_back(s.name);
    else if (tissue != kBodyOutline)
      parts.push_back({s.name, in_metres(std::move(s.mesh), *options.surface_unit), {}});
  }
  if (is_outlined) {
    auto outer = find_outer_boundary(mesh, file);
    ARTUS_TRY(outer);
    parts.push_back(
        {std::string(kBodyOutline), in_metres(std::move(*outer), *options.surface_unit), {}});
  }
  auto joint = import_parts(std::move(parts), options, file, progress);
  ARTUS_TRY(joint);
  joint->format = mesh.format;
  joint->is_partition = true;
  joint->notes.insert(joint->notes.end(), mesh.notes.begin(), mesh.notes.end());
  for (const std::string& name : fat)
    joint->notes.push_back("'" + name + "' is fat, which is the rest of the body");
  joint->notes.push_back("the mesh names no frame: taken for LPS; look at left and right");
  return joint;
}

}  // namespace artus
