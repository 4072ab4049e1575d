// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>

#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/html_page.h"
#include "artus/detail/reports/joint_report.h"
#include "artus/detail/reports/mesh_picture.h"
#include "artus/detail/reports/report_colours.h"

namespace artus {
namespace {

cv::Vec3b surface_colour() {
  return {205, 195, 180};
}
cv::Vec3b defect_colour() {
  return {40, 40, 220};
}

std::string line_of(const Finding& finding) {
  return finding.what +
         (finding.line > 0 ? " (line " + std::to_string(finding.line) + ")" : std::string()) +
         ": " + finding.message;
}

bool names_vertices(DefectKind kind) {
  return kind == DefectKind::unwelded_vertex || kind == DefectKind::non_manifold_vertex ||
         kind == DefectKind::non_finite_coordinate;
}

/// The surface as it was read, the faces of its defects in red.
ColouredMesh with_defects(const SurfaceMesh& mesh, const std::vector<Defect>& defects) {
  std::vector<bool> bad_face(mesh.triangles.size(), false);
  std::vector<bool> bad_vertex(mesh.vertices.size(), false);
  for (const Defect& d : defects) {
    if (d.kind == DefectKind::several_components || d.kind == DefectKind::implausible_size)
      continue;
    auto& marks = names_vertices(d.kind) ? bad_vertex : bad_face;
    for (const std::size_t e : d.elements)
      if (e < marks.size()) marks[e] = true;
  }
  ColouredMesh out = coloured(mesh, surface_colour());
  std::size_t i = 0;
  for (std::size_t f = 0; f < mesh.triangles.size() && i < out.mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (t != out.mesh.triangles[i]) continue;
    if (bad_face[f] || std::any_of(t.begin(), t.end(), [&](auto v) { return bad_vertex[v]; }))
      out.colours[i] = defect_colour();
    ++i;
  }
  return out;
}

/// Where two lines of one structure should stand together.
const PreparedSurface* prepared_of(const JointFile& file, const JointCheck& check,
                                   const std::string& name) {
  if (name == file.body.name) return &check.prepared.body;
  for (std::size_t i = 0; i < file.structures.size(); ++i)
    if (file.structures[i].name == name)
      return check.prepared.structures[i] ? &*check.prepared.structures[i] : nullptr;
  return nullptr;
}

void add_repaired_overview(HtmlPage& page, const JointFile& file, const JointCheck& check) {
  page.heading("All structures after repair, without the skin");
  std::vector<ColouredMesh> meshes;
  for (std::size_t i = 0; i < file.structures.size(); ++i)
    if (check.prepared.structures[i])
      meshes.push_back(coloured(check.prepared.structures[i]->mesh,
                                tissue_colour(file.structures[i].tissue, i)));
  for (const MeshView& view : picture_views(file.axes, file.side))
    page.picture(draw_meshes(meshes, view, large_picture()), view.name);
}

void add_surface(HtmlPage& page, const JointSources& sources, const JointCheck& check,
                 const Structure& s, const CheckedSurface& checked) {
  const JointFile& file = sources.joint();
  const auto& surface = std::get<SurfaceFile>(s.shape);
  page.open_card(s.name + " (" + s.tissue + ", " + surface.file.string() + ", line " +
                 std::to_string(s.line) + ")");
  for (const Finding& f : check.findings)
    if (f.what == s.name) page.point(to_string(f.verdict), f.message);
  const MeshView view = picture_views(file.axes, file.side).front();
  if (const auto read = sources.mesh(surface)) {
    const SurfaceMesh& mesh = **read;
    const auto defects = find_defects(mesh);
    std::vector<Vec3> marks;
    for (const Defect& d : defects)
      if (d.kind != DefectKind::several_components && d.position.allFinite())
        marks.push_back(d.position);
    page.picture(
        draw_meshes(std::vector{with_defects(mesh, defects)}, view, small_picture(), marks),
        defects.empty() ? "as it was read: no defect"
                        : "as it was read; defects red, a ring at the first of each kind");
  }
  const PreparedSurface* prepared = prepared_of(file, check, s.name);
  if (prepared != nullptr && !checked.repairs.empty() && !prepared->mesh.triangles.empty())
    page.picture(
        draw_meshes(std::vector{coloured(prepared->mesh, surface_colour())}, view, small_picture()),
        "after repair, " + fixed_number(checked.volume / kCubicCentimetre, 2) + " cm3");
  page.close_card();
}

void add_surface_table(HtmlPage& page, const JointFile& file, const JointCheck& check) {
  page.heading("Surfaces");
  std::vector<std::vector<std::string>> rows;
  for (const CheckedSurface& s : check.surfaces) {
    const PreparedSurface* prepared = prepared_of(file, check, s.name);
    rows.push_back({s.name,
                    s.refused.empty() ? (s.repairs.empty() ? "sound" : "mended") : "refused",
                    prepared != nullptr ? std::to_string(prepared->mesh.triangles.size()) : "-",
                    s.refused.empty() ? fixed_number(s.volume / kCubicCentimetre, 3) : "-",
                    std::to_string(s.repairs.size())});
  }
  page.table({{"surface", "of the structure; 'body' is the skin"},
              {"verdict", "sound: taken as it is; mended: repair saw to it; refused: mend it"},
              {"triangles", "after repair"},
              {"volume cm3", "enclosed after repair; does it fit the organ?"},
              {"repairs", "how many kinds of repair were needed"}},
             rows);
}

void add_crossings(HtmlPage& page, const JointCheck& check) {
  if (check.crossings.empty()) return;
  page.heading("Layers that cross");
  std::vector<std::vector<std::string>> rows;
  for (const Defect& c : check.crossings)
    rows.push_back({c.structure, c.message, std::to_string(c.count)});
  page.table({{"first", "stands first in joint.toml and keeps the overlap"},
              {"crosses", ""},
              {"faces", "pairs of triangles that cut through each other"}},
             rows);
}

}  // namespace

bool is_page(const std::filesystem::path& report) {
  return report.extension() == ".html";
}

Result<void> write_check_page(const JointSources& sources, const JointCheck& check,
                              const std::filesystem::path& path) {
  const JointFile& file = sources.joint();
  HtmlPage page(file.title + ": what artus check found");
  page.paragraph(std::to_string(file.structures.size()) + " structures, " +
                 std::to_string(check.count(Verdict::refused)) + " refusals, " +
                 std::to_string(check.count(Verdict::look)) + " findings to look at: the joint " +
                 (check.usable() ? "can be compiled." : "cannot be compiled as it is."));
  page.heading("What to do next");
  for (const Finding& f : check.findings)
    if (f.verdict <= Verdict::look) page.point(to_string(f.verdict), line_of(f));
  page.paragraph(check.usable()
                     ? "Compile it: artus compile " + file.folder.string()
                     : "Mend what is refused in joint.toml or in the surfaces and check again.");
  add_repaired_overview(page, file, check);
  add_surface_table(page, file, check);
  page.heading("Each surface");
  for (const CheckedSurface& checked : check.surfaces) {
    if (checked.name == file.body.name) add_surface(page, sources, check, file.body, checked);
    for (const Structure& s : file.structures)
      if (s.name == checked.name) add_surface(page, sources, check, s, checked);
  }
  add_crossings(page, check);
  return write_text(path, page.text());
}

}  // namespace artus
