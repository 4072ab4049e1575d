// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/scene_parts.h"

#include <algorithm>
#include <filesystem>

#include "artus/detail/anatomy/import/import_cells.h"
#include "artus/detail/anatomy/import/scene_reader.h"
#include "artus/detail/anatomy/import/voxel_masks.h"
#include "artus/detail/anatomy/surfaces/foreign_format.h"
#include "artus/detail/anatomy/surfaces/repair.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

std::string part_name(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

/// The line of an STL's or VTK's header that says RAS (3D Slicer writes SPACE=RAS).
bool says_ras(std::string_view bytes) {
  constexpr std::size_t kHead = 256;
  return bytes.substr(0, kHead).find("SPACE=RAS") != std::string_view::npos;
}

/// The polygons of VTK's XML files and of Gmsh's, which have no volume.
Result<ScenePart> surface_of_cells(std::string_view bytes, const std::string& name, double unit) {
  const auto mesh = read_cells(bytes, name);
  ARTUS_TRY(mesh);
  if ((*mesh)->has_volume())
    return fail(ErrorCode::unsupported,
                "it is a volume mesh (" + (*mesh)->format +
                    "), not a surface; import it by itself: `artus import FILE --units mm -o DIR`",
                name);
  auto surface = find_outer_boundary(**mesh, name);
  ARTUS_TRY(surface);
  for (Vec3& p : surface->vertices) p *= unit;
  return ScenePart{part_name(name), std::move(*surface), {"it names no frame: taken for LPS"}};
}

/// A skin around surfaces that have none: their points on a grid, closed and taken as a net.
SurfaceMesh hull_around(const std::vector<ImportedStructure>& structures) {
  constexpr double kCell = 2 * kMillimetre;
  constexpr double kOut = 16 * kMillimetre;
  constexpr double kIn = 8 * kMillimetre;
  Eigen::AlignedBox3d box;
  for (const auto& s : structures)
    for (const Vec3& p : s.mesh.vertices) box.extend(p);
  if (box.isEmpty()) return {};
  const Vec3 corner = box.min() - Vec3::Constant(kOut);
  VoxelMask mask;
  for (std::size_t a = 0; a < 3; ++a)
    mask.size[a] = static_cast<std::size_t>(
        std::min(1000.0,
                 std::ceil((box.sizes()[static_cast<Eigen::Index>(a)] + 2 * kOut) / kCell)) +
        1);
  mask.is_in.assign(mask.size[0] * mask.size[1] * mask.size[2], 0);
  const auto set = [&](const Vec3& p) {
    const Vec3 q = (p - corner) / kCell;
    std::size_t i = 0;
    for (std::size_t a = 3; a-- > 0;)
      i = i * mask.size[a] +
          std::min(mask.size[a] - 1,
                   static_cast<std::size_t>(std::max(0.0, q[static_cast<Eigen::Index>(a)] + 0.5)));
    mask.is_in[i] = 1;
  };
  for (const auto& s : structures)
    for (const Triangle& t : s.mesh.triangles) {
      const Vec3& a = s.mesh.vertices[t[0]];
      const Vec3& b = s.mesh.vertices[t[1]];
      const Vec3& c = s.mesh.vertices[t[2]];
      const double longest = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
      const int n = std::min(200, 1 + static_cast<int>(longest / kCell));
      for (int i = 0; i <= n; ++i)
        for (int k = 0; i + k <= n; ++k) set(a + (b - a) * i / n + (c - a) * k / n);
    }
  const VoxelMask hull = closed_hull(mask, Vec3::Constant(kCell), kOut, kIn, kCell);
  const std::vector<std::uint16_t> labels(hull.is_in.begin(), hull.is_in.end());
  SurfaceNet net = make_surface_net(labels, hull.size);
  smooth(net);
  IndexFrame frame = IndexFrame::Identity();
  frame.linear() *= kCell;
  frame.translation() = corner;
  return make_outer_surface(net, frame).mesh;
}

/// Area of the flat pieces that would close a part, over its own.
std::optional<std::string> why_too_open(const SurfaceMesh& mesh) {
  constexpr double kMostOpen = 0.2;
  RepairOptions options;
  options.largest_fill_share = kMostOpen;
  options.wrap = WrapPolicy::never;
  options.remove_self_intersections = false;  // compile does; here only openings matter
  const auto outcome = repair_surface(mesh, options);
  if (outcome) return std::nullopt;
  return outcome.error().message +
         " (in joint.toml: thicken = 1 for a sheet; a landmark for a mark)";
}

/// Each part becomes the body, a structure, or is left out with the reason.
void sort_parts(std::vector<ScenePart>& parts, const ImportOptions& options,
                const StructureNames& bundled, const Progress& progress, ImportedJoint& joint) {
  double largest_outline = 0;
  const auto tissue_of = [&](const ScenePart& part) {
    const auto known = find_tissue(options.names, bundled, part.name, {});
    return known ? known->tissue : std::string();
  };
  const bool has_outline = std::any_of(parts.begin(), parts.end(), [&](const ScenePart& part) {
    return tissue_of(part) == kBodyOutline;
  });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    ScenePart& part = parts[i];
    if (progress)
      progress("looking at " + part.name,
               0.1 + 0.7 * static_cast<double>(i) / static_cast<double>(parts.size()));
    for (const std::string& note : part.notes) joint.notes.push_back(part.name + ": " + note);
    ImportedStructure s;
    s.source = part.name;
    const auto known = find_tissue(options.names, bundled, part.name, {});
    s.by = known ? known->by : "no tissue is known for this name";
    if (known) s.tissue = known->tissue;
    s.volumes.fitted = signed_volume(part.mesh);
    const double volume = std::abs(s.volumes.fitted);
    const bool is_skin = known && known->tissue == "skin";
    if (known && (known->tissue == kBodyOutline || (is_skin && !has_outline))) {
      if (volume > largest_outline) {
        largest_outline = volume;
        joint.body = std::move(part.mesh);
        joint.body_by = "surface '" + part.name + "'";
      }
      continue;
    }
    if (const auto why = known ? why_too_open(part.mesh) : std::nullopt) {
      s.by = *why;
      joint.left_out.push_back(std::move(s));
      continue;
    }
    s.mesh = std::move(part.mesh);
    joint.has_skin = joint.has_skin || is_skin;
    (known ? joint.structures : joint.left_out).push_back(std::move(s));
  }
}

}  // namespace

Result<std::vector<ScenePart>> read_scene_parts(std::string_view bytes, const std::string& name,
                                                double unit) {
  const SourceKind kind = kind_of_source(bytes, name);
  if (kind == SourceKind::vtk_legacy) {
    auto part = parse_vtk(bytes, name, unit);
    ARTUS_TRY(part);
    return std::vector<ScenePart>{std::move(*part)};
  }
  if (kind == SourceKind::vtk_xml || kind == SourceKind::gmsh) {
    auto part = surface_of_cells(bytes, name, unit);
    ARTUS_TRY(part);
    return std::vector<ScenePart>{std::move(*part)};
  }
  const bool is_obj = std::filesystem::path(name).extension() == ".obj";
  const bool is_scene = kind == SourceKind::gltf || foreign_format(bytes, name) == "3MF";
  if (is_scene || (is_obj && reads_scenes())) return read_scene(bytes, name, unit);
  auto mesh = parse_surface(bytes, name, unit);
  ARTUS_TRY(mesh);
  ScenePart part{part_name(name), std::move(*mesh), {}};
  if (says_ras(bytes)) {
    for (Vec3& p : part.mesh.vertices) p = Vec3(-p.x(), -p.y(), p.z());
    part.notes.push_back("its header says SPACE=RAS: turned to LPS");
  }
  return std::vector<ScenePart>{std::move(part)};
}

Result<ImportedJoint> import_parts(std::vector<ScenePart> parts, const ImportOptions& options,
                                   const std::string& file, const Progress& progress) {
  const auto bundled = read_bundled_structure_names();
  ARTUS_TRY(bundled);
  ImportedJoint joint;
  joint.name = options.name.empty() ? joint_name_of(file) : options.name;
  joint.title = std::filesystem::path(file).filename().string();
  joint.format = "surfaces";
  joint.side = options.side;
  sort_parts(parts, options, *bundled, progress, joint);
  if (joint.structures.empty())
    return fail(
        ErrorCode::invalid,
        printed("none of its %zu parts is a closed structure of a known tissue%s", parts.size(),
                joint.left_out.empty()
                    ? ""
                    : (" ('" + joint.left_out.front().source + "': " + joint.left_out.front().by +
                       "); names.toml for --labels "
                       "says what names mean: [[map]] match, tissue")
                          .c_str()),
        file);
  std::stable_sort(joint.structures.begin(), joint.structures.end(), [](auto& a, auto& b) {
    return std::abs(a.volumes.fitted) < std::abs(b.volumes.fitted);
  });
  if (joint.body.triangles.empty()) {
    joint.body = hull_around(joint.structures);
    joint.body_by = "a hull around all surfaces";
    joint.body_is_assumed = true;
    joint.assumed.push_back(
        "skin: there is none; a hull around all surfaces, 8 mm outside of them");
  }
  if (!joint.has_skin)
    joint.assumed.push_back("dermis: a layer of 1.8 mm under the skin's surface");
  joint.assumed.push_back("fat: what no structure claims");
  name_structures(joint);
  ARTUS_TRY(choose_region(joint, options));
  return joint;
}

}  // namespace artus
