// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

#include <opencv2/imgproc.hpp>

#include "artus/detail/anatomy/surfaces/distance_tree.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/html_page.h"
#include "artus/detail/reports/joint_report.h"
#include "artus/detail/reports/mesh_picture.h"
#include "artus/detail/reports/report_colours.h"
#include "artus/raycast/scene.h"

namespace artus {
namespace {

constexpr double kWorst = 0.5 * kMillimetre;  // a distance that is red
constexpr int kSlicePixels = 340;             // of each slice's sides

cv::Vec3b colour_of(const CompiledJoint& joint, RegionId region) {
  if (region == kOutside) return {255, 255, 255};
  if (region == kBeyond) return {225, 225, 225};
  return tissue_colour(joint.tissue_of(region).name, region);
}

void add_overview(HtmlPage& page, const JointFile& file, const CompiledJoint& joint) {
  page.heading("The compiled body, without skin and fat");
  std::vector<ColouredMesh> meshes;
  for (RegionId r = kFirstRegion + 1; r < joint.regions.size(); ++r)
    if (joint.tissue_of(r).name != "skin")
      meshes.push_back(coloured(region_surface(joint, r), colour_of(joint, r)));
  for (const MeshView& view : picture_views(file.axes, file.side))
    page.picture(draw_meshes(meshes, view, large_picture()), view.name);
}

/// The plane through a point, and how its pixels lie.
struct Slice {
  std::string name;
  Vec3 centre = Vec3::Zero(), right = Vec3::UnitX(), up = Vec3::UnitZ();
  double half = 0;  // m, of each side

  [[nodiscard]] cv::Point pixel(const Vec3& p) const {
    const double scale = kSlicePixels / (2 * half);
    return {static_cast<int>(kSlicePixels / 2.0 + scale * (p - centre).dot(right)),
            static_cast<int>(kSlicePixels / 2.0 - scale * (p - centre).dot(up))};
  }
  [[nodiscard]] Vec3 point(int x, int y) const {
    const double step = 2 * half / kSlicePixels;
    return centre + (x + 0.5 - kSlicePixels / 2.0) * step * right -
           (y + 0.5 - kSlicePixels / 2.0) * step * up;
  }
};

cv::Mat draw_slice(const Scene& scene, const Slice& slice, std::set<RegionId>& seen) {
  const CompiledJoint& joint = scene.joint();
  cv::Mat image(kSlicePixels, kSlicePixels, CV_8UC3);
  for (int y = 0; y < kSlicePixels; ++y)
    for (int x = 0; x < kSlicePixels; ++x) {
      const RegionId region = scene.region_at(slice.point(x, y));
      seen.insert(region);
      image.at<cv::Vec3b>(y, x) = colour_of(joint, region);
    }
  for (const PlannedInjection& pass : joint.injections)
    cv::arrowedLine(image, slice.pixel(pass.entry), slice.pixel(pass.target), cv::Scalar(0, 0, 0),
                    1, cv::LINE_AA, 0, 0.06);
  const Vec3 face = 20 * kMillimetre * joint.X_JP_default.linear().col(0);
  const Vec3 probe = joint.X_JP_default.translation();
  cv::line(image, slice.pixel(probe - face), slice.pixel(probe + face), cv::Scalar(180, 0, 180), 3);
  return image;
}

void add_slices(HtmlPage& page, const JointFile& file, const CompiledJoint& joint) {
  page.heading("Slices, with the planned needles (arrows) and the probe's face (violet)");
  Eigen::AlignedBox3d box;
  for (const Vec3& p : joint.mesh.vertices) box.extend(p);
  const Vec3 target =
      joint.injections.empty() ? Vec3(box.center()) : joint.injections.front().target;
  const double half = box.sizes().maxCoeff() / 2;
  const auto views = picture_views(file.axes, file.side);
  const Vec3 behind = views[0].up.cross(views[0].right);
  const Pose& X_JP = joint.X_JP_default;
  const Scene scene(std::make_shared<const CompiledJoint>(joint));
  std::set<RegionId> seen;
  const Vec3 down = -X_JP.linear().col(2);
  for (Slice slice :
       {Slice{"in the probe's plane", target, X_JP.linear().col(0), down, half},
        Slice{"from the front", target, views[0].right, views[0].up, half},
        Slice{"from below, the front at the top", target, views[0].right, Vec3(-behind), half}}) {
    // Through the target, with the body's middle in the picture's.
    const Vec3 normal = slice.right.cross(slice.up);
    slice.centre = box.center() + normal.dot(target - box.center()) * normal;
    page.picture(draw_slice(scene, slice, seen), slice.name);
  }
  std::string names;
  for (const RegionId r : seen)
    if (r >= kFirstRegion) names += (names.empty() ? "" : ", ") + joint.regions[r].name;
  page.paragraph("White is outside, light grey beyond the region of interest. Cut here: " + names +
                 ".");
}

/// A region's surface coloured by its distance to the file it came from.
ColouredMesh by_distance(const CompiledJoint& joint, RegionId region, const DistanceTree& source) {
  ColouredMesh out = coloured(region_surface(joint, region), {});
  for (std::size_t i = 0; i < out.colours.size(); ++i)
    out.colours[i] = distance_colour(
        source.distance(triangle_centre(out.mesh, out.mesh.triangles[i]), 2 * kWorst), kWorst);
  return out;
}

void add_structures(HtmlPage& page, const JointSources& sources, const CompileOutcome& outcome) {
  const JointFile& file = sources.joint();
  page.heading("Each structure: green lies on its surface, red 0.5 mm or more from it");
  page.paragraph(
      "Red where another structure cut something off, where the region of interest ends, or where "
      "a "
      "repair had to make a surface; elsewhere give the structure a smaller facet_distance.");
  const MeshView view = picture_views(file.axes, file.side).front();
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    const Structure& s = file.structures[i];
    const StructureReport& report = outcome.report.structures[i + 1];  // behind the filler
    page.open_card(s.name + " (" + s.tissue + ", " + report.kind + ")");
    if (!report.refused.empty()) page.point("refused", report.refused);
    for (const std::string& warning : report.warnings) page.point("look", warning);
    for (const std::string& repair : report.repairs) page.point("mended", repair);
    const auto region = static_cast<RegionId>(kFirstRegion + 1 + i);
    const auto* surface = std::get_if<SurfaceFile>(&s.shape);
    if (report.tetrahedra > 0 && surface != nullptr) {
      if (const auto mesh = sources.mesh(*surface))
        page.picture(draw_meshes(std::vector{by_distance(outcome.joint, region,
                                                         DistanceTree(coloured(**mesh, {}).mesh))},
                                 view, small_picture()),
                     "distance to " + surface->file.string());
    } else if (report.tetrahedra > 0) {
      page.picture(draw_meshes(std::vector{coloured(region_surface(outcome.joint, region),
                                                    colour_of(outcome.joint, region))},
                               view, small_picture()),
                   "made by artus");
    }
    page.close_card();
  }
}

void add_table(HtmlPage& page, const CompileReport& report) {
  page.heading("Numbers");
  std::vector<std::vector<std::string>> rows;
  for (const StructureReport& s : report.structures) {
    if (!s.refused.empty()) {
      rows.push_back({s.name, "refused", "-", "-", "-", "-", "-", "-", "-"});
      continue;
    }
    rows.push_back({s.name, s.kind, fixed_number(s.region_volume / kCubicCentimetre, 3),
                    fixed_number(s.lost_volume / kCubicCentimetre, 3),
                    fixed_number(s.resolved_volume / kCubicCentimetre, 3),
                    fixed_number(100 * s.volume_error(), 2) + (s.is_changed() ? " !" : ""),
                    fixed_number(s.distance.mean / kMillimetre, 3),
                    fixed_number(s.distance.percentile95 / kMillimetre, 3),
                    std::to_string(s.parts)});
  }
  page.table(
      {{"structure", "the first line is what no structure claims"},
       {"kind", "surface: of a file; shell, cap, gap, end: made by artus; filler"},
       {"input cm3", "its volume inside skin and region of interest"},
       {"lost cm3", "of that to structures before it in joint.toml"},
       {"is cm3", "of its tetrahedra"},
       {"error %", "is, over input less lost; '!': this or what is lost is more than 5 %"},
       {"mean mm",
        "distance of its triangles to its surface, mean of what lies inside the region, by area"},
       {"p95 mm", "95 % of its area inside the region is nearer than this"},
       {"parts", "connected pieces; more than one where others cut through it"}},
      rows);
  page.paragraph(std::to_string(report.tetrahedra) + " tetrahedra, " +
                 std::to_string(report.quality.inverted) + " inverted, " +
                 fixed_number(report.quality.above_8_deg_percent(), 3) +
                 " % without a dihedral angle below 8 degrees.");
}

}  // namespace

Result<void> write_compile_page(const JointSources& sources, const CompileOutcome& outcome,
                                const std::filesystem::path& compiled,
                                const std::filesystem::path& path) {
  const JointFile& file = sources.joint();
  HtmlPage page(file.title + ": what artus compile made");
  page.heading("What to do next");
  for (const StructureReport& s : outcome.report.structures) {
    if (!s.refused.empty()) page.point("refused", s.name + ": " + s.refused);
    for (const std::string& warning : s.warnings) page.point("look", s.name + ": " + warning);
  }
  for (const std::string& note : outcome.report.notes) page.point("note", note);
  page.paragraph("Look at the slices and at what is red below; then artus image -j " +
                 compiled.string() +
                 " -o image.png shows the echo, and artus run three-injections -j " +
                 compiled.string() + " --out out/run injects.");
  add_slices(page, file, outcome.joint);
  add_overview(page, file, outcome.joint);
  add_table(page, outcome.report);
  add_structures(page, sources, outcome);
  return write_text(path, page.text());
}

}  // namespace artus
