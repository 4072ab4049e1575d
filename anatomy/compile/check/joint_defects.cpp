// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/joint_defects.h"

#include <algorithm>

namespace artus {
namespace {

/// The partition of a structure. An untouched body beside a single partition is its outer border.
std::string borders_of(const JointFile& joint, const Structure& structure) {
  if (&structure != &joint.body) return structure.partition;
  const auto* surface = std::get_if<SurfaceFile>(&structure.shape);
  const bool is_border =
      joint.partitions.size() == 1 && surface != nullptr && surface->repair == "none";
  return is_border ? joint.partitions.front().name : std::string();
}

void append_defects_of(const JointSources& sources, const Structure& structure,
                       const DefectOptions& options, std::vector<NamedSurface>& surfaces,
                       std::vector<Defect>& defects) {
  const JointFile& joint = sources.joint();
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
  const std::string partition = borders_of(joint, structure);
  const auto mesh = sources.mesh(*surface);
  if (!mesh) {
    defects.push_back({DefectKind::unreadable_file,
                       structure.name,
                       1,
                       {},
                       Vec3::Zero(),
                       mesh.error().to_string()});
    return;
  }
  DefectOptions own = options;
  // What shares its borders with its neighbours was cut from a grid, and is no tangle.
  own.self_intersections = options.self_intersections && partition.empty();
  for (auto& d : find_defects(**mesh, own)) {
    d.structure = structure.name;
    defects.push_back(std::move(d));
  }
  surfaces.push_back({structure.name, structure.tissue, **mesh, surface->has_own_unit, partition});
}

}  // namespace

std::vector<Defect> find_joint_defects(const JointSources& sources, const DefectOptions& options,
                                       const Progress& progress) {
  const JointFile& joint = sources.joint();
  std::vector<Defect> defects;
  std::vector<NamedSurface> surfaces;
  append_defects_of(sources, joint.body, options, surfaces, defects);
  std::size_t n_done = 0;
  for (const auto& structure : joint.structures) {
    if (progress)
      progress("checking " + structure.name,
               static_cast<double>(n_done++) / static_cast<double>(joint.structures.size()));
    append_defects_of(sources, structure, options, surfaces, defects);
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
