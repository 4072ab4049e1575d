// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/import_page.h"

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/html_page.h"
#include "artus/detail/reports/mesh_picture.h"
#include "artus/detail/reports/report_colours.h"

namespace artus {
namespace {

constexpr double kMuchChanged = 0.05;  // of a volume

std::string in_cm3(double volume) {
  return fixed_number(volume / kCubicCentimetre, 3);
}

/// By how much of the counted volume a surface differs; 0 where nothing was counted.
double change_of(const ImportedStructure& s) {
  return s.volumes.counted > 0 ? s.volumes.fitted / s.volumes.counted - 1 : 0;
}

void add_summary(HtmlPage& page, const ImportedJoint& joint) {
  page.paragraph(printed("%zu structures of %s (%s)", joint.structures.size(), joint.title.c_str(),
                         joint.format.c_str()) +
                 (joint.voxel > 0 ? printed("; voxels of %.3f mm (edge of a cube of their volume)",
                                            joint.voxel / kMillimetre)
                                  : std::string()) +
                 "; side: " + joint.side + "; axes: LPS, mm.");
  for (const std::string& text : joint.assumed) page.point("look", "assumed: " + text);
  for (const std::string& text : joint.notes) page.point("look", text);
  for (const ImportedStructure& s : joint.left_out)
    page.point("note", "left out: '" + s.source + "': " + s.by);
  for (const ImportedStructure& s : joint.structures)
    if (std::abs(change_of(s)) > kMuchChanged)
      page.point("look", printed("'%s' encloses %.1f %% %s than its voxels", s.name.c_str(),
                                 100 * std::abs(change_of(s)), change_of(s) > 0 ? "more" : "less"));
}

void add_overview(HtmlPage& page, const ImportedJoint& joint) {
  page.heading("The joint");
  std::vector<ColouredMesh> meshes;
  for (std::size_t i = 0; i < joint.structures.size(); ++i)
    if (joint.structures[i].tissue != "skin")
      meshes.push_back(
          coloured(joint.structures[i].mesh, tissue_colour(joint.structures[i].tissue, i)));
  const std::vector<ColouredMesh> body{coloured(joint.body, tissue_colour("skin", 0))};
  for (const MeshView& view : picture_views("LPS", joint.side)) {
    page.picture(draw_meshes(meshes, view, large_picture()), view.name + ", without the skin");
    page.picture(draw_meshes(body, view, large_picture()),
                 view.name + ": the body's surface, by " + joint.body_by);
  }
}

void add_structures(HtmlPage& page, const ImportedJoint& joint) {
  page.heading("Structures, before and after");
  const MeshView view = picture_views("LPS", joint.side).front();
  for (std::size_t i = 0; i < joint.structures.size(); ++i) {
    const ImportedStructure& s = joint.structures[i];
    const cv::Vec3b colour = tissue_colour(s.tissue, i);
    page.open_card(s.name + " (" + s.tissue + ", by " + s.by + ")");
    if (!s.before.triangles.empty())
      page.picture(draw_meshes(std::vector{coloured(s.before, colour)}, view, small_picture()),
                   "as the file has it: " + in_cm3(s.volumes.counted) + " cm3");
    page.picture(draw_meshes(std::vector{coloured(s.mesh, colour)}, view, small_picture()),
                 "as it became: " + in_cm3(s.volumes.fitted) + " cm3");
    page.close_card();
  }
}

void add_table(HtmlPage& page, const ImportedJoint& joint) {
  page.heading("Volumes");
  std::vector<std::vector<std::string>> rows;
  for (const ImportedStructure& s : joint.structures) {
    const bool counted = s.volumes.counted > 0;
    rows.push_back({s.name, s.source, s.tissue, counted ? printed("%.0f", s.value) : "-",
                    counted ? std::to_string(s.n_voxels) : "-",
                    counted ? in_cm3(s.volumes.counted) : "-",
                    counted ? in_cm3(s.volumes.smoothed) : "-", in_cm3(s.volumes.fitted),
                    counted ? fixed_number(100 * change_of(s), 2) : "-"});
  }
  page.table({{"structure", "as joint.toml names it"},
              {"name in the file", "", true},
              {"tissue", "of the tissue library"},
              {"label", "its number in the file"},
              {"voxels", "that have it"},
              {"cm3", "of its voxels"},
              {"smoothed", "cm3 that its surface encloses after smoothing"},
              {"fitted", "cm3 after its surface was moved to hold what its voxels hold"},
              {"%", "of the voxels' volume that the surface has more or less"}},
             rows);
}

}  // namespace

Result<void> write_import_page(const ImportedJoint& joint, const std::filesystem::path& file) {
  HtmlPage page("Import of " + joint.title);
  add_summary(page, joint);
  add_overview(page, joint);
  add_structures(page, joint);
  add_table(page, joint);
  return write_text(file, page.text());
}

}  // namespace artus
