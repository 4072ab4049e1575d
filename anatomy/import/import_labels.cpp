// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/import/body_outline.h"
#include "artus/detail/anatomy/import/imported_joint.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kTallVoxel = 2.5;  // of a voxel's longest edge to its shortest

/// Tissues of all segments, and what is left out.
Result<SegmentRoles> find_roles(const LabelVolume& volume, const ImportOptions& options,
                                std::vector<ImportedStructure>& structures) {
  const auto bundled = read_bundled_structure_names();
  ARTUS_TRY(bundled);
  SegmentRoles roles;
  for (const LabelSegment& segment : volume.segments) {
    ImportedStructure s;
    s.source = segment.name;
    s.value = segment.value;
    s.n_voxels = segment.n_voxels;
    const auto known = find_tissue(options.names, *bundled, segment.name, segment.code);
    if (known) {
      s.tissue = known->tissue;
      s.by = known->by;
    } else {
      s.by = "no tissue is known for this name";
    }
    const bool is_there = segment.n_voxels > 0;
    roles.is_outline.push_back(is_there && known && known->tissue == kBodyOutline);
    roles.is_skin.push_back(is_there && known && known->tissue == "skin");
    // Fat is what no structure claims.
    roles.is_left_out.push_back(!known || known->tissue == "fat");
    if (s.tissue == "fat") s.by += "; fat is the rest of the body";
    structures.push_back(std::move(s));
  }
  const bool has_any = std::any_of(structures.begin(), structures.end(), [](const auto& s) {
    return !s.tissue.empty() && s.tissue != kBodyOutline && s.tissue != "fat";
  });
  if (has_any) return roles;
  std::string names;
  for (const auto& s : structures) names += (names.empty() ? "'" : ", '") + s.source + "'";
  return fail(ErrorCode::invalid,
              "no tissue is known for any of its labels (" + names.substr(0, 300) +
                  "); write a file names.toml with lines '[[map]]', 'match = \"" +
                  plain_structure_name(structures.front().source) +
                  "\"', 'tissue = \"bone\"' and give it with --labels names.toml");
}

void take_surfaces(ImportedJoint& joint, std::vector<ImportedStructure> structures,
                   const SegmentRoles& roles, std::vector<LabelSurface> surfaces,
                   std::vector<LabelSurface> before) {
  for (std::size_t i = 0; i < structures.size(); ++i) {
    ImportedStructure& s = structures[i];
    if (roles.is_outline[i]) continue;
    if (roles.is_left_out[i]) {
      joint.left_out.push_back(std::move(s));
      continue;
    }
    s.mesh = std::move(surfaces[i].mesh);
    s.before = std::move(before[i].mesh);
    joint.has_skin = joint.has_skin || roles.is_skin[i];
    joint.structures.push_back(std::move(s));
  }
  std::stable_sort(joint.structures.begin(), joint.structures.end(),
                   [](const auto& a, const auto& b) { return a.n_voxels < b.n_voxels; });
}

void take_body(ImportedJoint& joint, LabelSurface outer) {
  for (std::size_t f = 0; f < outer.is_cut.size(); ++f)
    if (outer.is_cut[f] != 0) joint.cuts.triangles.push_back(outer.mesh.triangles[f]);
  std::vector<std::uint32_t> to(outer.mesh.vertices.size(), kNoVertex);
  for (Triangle& t : joint.cuts.triangles)
    for (std::uint32_t& v : t) {
      if (to[v] == kNoVertex) {
        to[v] = static_cast<std::uint32_t>(joint.cuts.vertices.size());
        joint.cuts.vertices.push_back(outer.mesh.vertices[v]);
      }
      v = to[v];
    }
  joint.body = std::move(outer.mesh);
}

void tell(ImportedJoint& joint, const LabelVolume& volume, const BodyOutline& outline) {
  joint.body_by = outline.by;
  joint.body_is_assumed = outline.assumed;
  if (outline.assumed)
    joint.assumed.push_back(
        "skin: the file has none; a hull around all labels, 8 mm outside of them (--image SCAN "
        "takes it from the scan)");
  if (!joint.has_skin)
    joint.assumed.push_back("dermis: a layer of 1.8 mm under the skin's surface");
  joint.assumed.push_back("fat: what no structure claims");
  const Vec3 edges = volume.X_LI.linear().colwise().norm();
  if (edges.maxCoeff() > kTallVoxel * edges.minCoeff())
    joint.notes.push_back(printed(
        "voxels are %.2g x %.2g x %.2g mm: steps between slices stay in the surfaces; a scan "
        "with thinner slices gives smoother ones",
        edges.x() / kMillimetre, edges.y() / kMillimetre, edges.z() / kMillimetre));
  if (!joint.cuts.triangles.empty())
    joint.notes.push_back(printed(
        "%.3g cm2 of the body's surface lie on the border of the volume and are marked as a cut, "
        "not as skin",
        surface_area(joint.cuts) / 1e-4));
  const bool has_bone = std::any_of(joint.structures.begin(), joint.structures.end(),
                                    [](const auto& s) { return s.tissue == "bone"; });
  if (!has_bone && joint.cuts.triangles.empty())
    joint.notes.push_back("no structure is bone and nothing is cut: nothing will hold the tissue");
}

}  // namespace

Result<ImportedJoint> import_labels(LabelVolume volume, const ImportOptions& options,
                                    const std::string& file, const Progress& progress) {
  const auto step = [&](const char* what, double fraction) {
    if (progress) progress(what, fraction);
  };
  ImportedJoint joint;
  joint.name = options.name.empty() ? joint_name_of(file) : options.name;
  joint.title = std::filesystem::path(file).filename().string();
  joint.format = volume.format;
  joint.side = options.side;
  joint.voxel = volume.voxel_edge();
  joint.is_partition = true;
  joint.notes = volume.notes;
  std::vector<ImportedStructure> structures;
  auto roles = find_roles(volume, options, structures);
  if (!roles) return fail(roles.error().code, roles.error().message, file);
  step("finding the skin", 0.1);
  const auto outline = outline_body(volume, *roles, options.image, file);
  ARTUS_TRY(outline);
  step("making surfaces", 0.3);
  SurfaceNet net = make_surface_net(volume.labels, volume.size);
  volume.labels = {};
  auto before = make_label_surfaces(net, structures.size(), volume.X_LI);  // voxel faces
  step("smoothing surfaces", 0.5);
  smooth(net);
  std::vector<std::size_t> counts;
  for (const LabelSegment& s : volume.segments) counts.push_back(s.n_voxels);
  for (std::size_t i = 0; i < structures.size(); ++i)
    if (roles->is_outline[i] || roles->is_left_out[i]) counts[i] = 0;
  const auto volumes = fit_volumes(net, counts, volume.X_LI);
  for (std::size_t i = 0; i < structures.size(); ++i) structures[i].volumes = volumes[i];
  step("taking surfaces apart", 0.7);
  auto surfaces = make_label_surfaces(net, structures.size(), volume.X_LI);
  take_surfaces(joint, std::move(structures), *roles, std::move(surfaces), std::move(before));
  take_body(joint, make_outer_surface(net, volume.X_LI));
  tell(joint, volume, *outline);
  name_structures(joint);
  step("choosing the region", 0.9);
  ARTUS_TRY(choose_region(joint, options));
  return joint;
}

}  // namespace artus
