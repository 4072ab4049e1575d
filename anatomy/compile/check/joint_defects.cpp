// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/joint_defects.h"

#include <algorithm>

#include "artus/detail/anatomy/surfaces/surface_io.h"

namespace artus {
namespace {

SurfaceMesh read_of(const JointFile& joint, const Structure& structure, const SurfaceFile& surface,
                    std::vector<Defect>& defects) {
  auto mesh = read_surface(joint.surface_folder / surface.file, surface.unit);
  if (mesh) return std::move(*mesh);
  defects.push_back(
      {DefectKind::unreadable_file, structure.name, 1, {}, Vec3::Zero(), mesh.error().to_string()});
  return {};
}

void append_defects_of(const JointFile& joint, const Structure& structure,
                       const DefectOptions& options, std::vector<NamedSurface>& surfaces,
                       std::vector<Defect>& defects) {
  const bool is_known = std::any_of(joint.tissues.begin(), joint.tissues.end(),
                                    [&](const Tissue& t) { return t.name == structure.tissue; });
  if (!is_known)
    defects.push_back({DefectKind::unknown_tissue,
                       structure.name,
                       1,
                       {},
                       Vec3::Zero(),
                       "the tissue '" + structure.tissue + "' is not in the library"});
  const auto* surface = std::get_if<SurfaceFile>(&structure.shape);
  if (surface == nullptr) return;
  const std::size_t before = defects.size();
  auto mesh = read_of(joint, structure, *surface, defects);
  if (defects.size() > before) return;
  for (auto& d : find_defects(mesh, options)) {
    d.structure = structure.name;
    defects.push_back(std::move(d));
  }
  surfaces.push_back({structure.name, structure.tissue, std::move(mesh), surface->has_own_unit});
}

}  // namespace

std::vector<Defect> find_joint_defects(const JointFile& joint, const DefectOptions& options,
                                       const Progress& progress) {
  std::vector<Defect> defects;
  std::vector<NamedSurface> surfaces;
  append_defects_of(joint, joint.body, options, surfaces, defects);
  std::size_t n_done = 0;
  for (const auto& structure : joint.structures) {
    if (progress)
      progress("checking " + structure.name,
               static_cast<double>(n_done++) / static_cast<double>(joint.structures.size()));
    append_defects_of(joint, structure, options, surfaces, defects);
  }
  const auto append = [&defects](std::vector<Defect> more) {
    for (auto& d : more) defects.push_back(std::move(d));
  };
  append(find_outliers(surfaces));
  if (progress) progress("looking for layers that cross", 1);
  append(find_crossings(surfaces));
  return defects;
}

}  // namespace artus
