// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/moment_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/reports/report_colours.h"

namespace artus {
namespace {

cv::Vec3b target_colour() {
  return {70, 160, 60};
}
cv::Vec3b spare_colour() {
  return {50, 50, 210};
}
cv::Vec3b needle_colour() {
  return {150, 60, 20};
}
cv::Vec3b tip_colour() {
  return {20, 110, 240};
}
cv::Vec3b picture_colour() {
  return {120, 120, 120};
}
cv::Vec3b face_colour() {
  return {90, 90, 90};
}
constexpr double kBeside = 10e-3;   // m around the picture that are drawn
constexpr double kBehind = 25e-3;   // m behind its plane
constexpr double kThin = 0.25e-3;   // m, radius of lines
constexpr double kShaft = 0.6e-3;   // m, radius at which a shaft can be seen
constexpr double kSphere = 1.4e-3;  // m, radius of a point

/// A tube of six sides.
ColouredMesh tube(const Vec3& from, const Vec3& to, double radius, const cv::Vec3b& colour) {
  const Eigen::Matrix3d frame = make_pose(from, to - from, Vec3::Zero()).linear();
  SurfaceMesh mesh;
  constexpr std::uint32_t kSides = 6;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    const Vec3 aside = radius * (std::cos(angle) * frame.col(0) + std::sin(angle) * frame.col(1));
    mesh.vertices.emplace_back(from + aside);
    mesh.vertices.emplace_back(to + aside);
    const std::uint32_t a = 2 * i;
    const std::uint32_t b = 2 * ((i + 1) % kSides);
    mesh.triangles.push_back({a, b, a + 1});
    mesh.triangles.push_back({b, b + 1, a + 1});
  }
  return coloured(mesh, colour);
}

/// A ball, of an octahedron whose faces are cut in four once.
ColouredMesh ball(const Vec3& centre, double radius, const cv::Vec3b& colour) {
  SurfaceMesh mesh;
  const auto add = [&](const Vec3& p) {
    mesh.vertices.emplace_back(centre + radius * p.normalized());
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) {
        const std::uint32_t a = add(Vec3(x, 0, 0));
        const std::uint32_t b = add(Vec3(0, y, 0));
        const std::uint32_t c = add(Vec3(0, 0, z));
        const std::uint32_t ab = add(Vec3(x, y, 0));
        const std::uint32_t bc = add(Vec3(0, y, z));
        const std::uint32_t ca = add(Vec3(x, 0, z));
        for (const Triangle& t :
             {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
          mesh.triangles.push_back(t);
      }
  return coloured(mesh, colour);
}

/// What of a mesh lies behind the picture's plane and near the picture, in the probe's frame.
ColouredMesh cut(const ColouredMesh& mesh, const Pose& X_PJ, const Eigen::AlignedBox3d& box) {
  ColouredMesh out;
  for (const Vec3& p : mesh.mesh.vertices) out.mesh.vertices.emplace_back(X_PJ * p);
  for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.mesh.triangles[i];
    const auto inside = [&](std::uint32_t v) {
      return box.contains(out.mesh.vertices[v]);
    };
    if (!std::all_of(t.begin(), t.end(), inside)) continue;
    out.mesh.triangles.push_back(t);
    out.colours.push_back(mesh.colours[i]);
  }
  return out;
}

/// Keeps the picture's scale however little is drawn: triangles without area.
ColouredMesh corners_of(const Eigen::AlignedBox3d& box) {
  SurfaceMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    const auto v = static_cast<std::uint32_t>(i);
    mesh.triangles.push_back({v, v, v});
  }
  return coloured(mesh, picture_colour());
}

}  // namespace

MomentView::MomentView(const Scenario& scenario, const Scene& scene, const SessionParams& params)
    : transducer_(params.transducer),
      depth_(params.image.depth),
      length_(needle_length_of(params)) {
  const CompiledJoint& joint = scene.joint();
  for (RegionId r = kFirstRegion; r < joint.regions.size(); ++r) {
    const std::string& name = joint.regions[r].name;
    const bool spared =
        std::any_of(scenario.avoid.begin(), scenario.avoid.end(),
                    [&](const ScenarioAvoid& zone) { return zone.structure == name; });
    const bool sought = !name.empty() && (name == scenario.target.structure ||
                                          std::find(scenario.find.begin(), scenario.find.end(),
                                                    name) != scenario.find.end());
    const Tissue& tissue = joint.tissue_of(r);
    if (!spared && !sought && !tissue.haptic.hard) continue;
    const cv::Vec3b colour = spared   ? spare_colour()
                             : sought ? target_colour()
                                      : tissue_colour(tissue.name, r);
    body_.push_back(coloured(region_surface(joint, r), colour));
  }
  if (scenario.target.structure.empty() && scenario.find.empty())
    body_.push_back(ball(scenario.target.point, kSphere, target_colour()));
}

/// The picture's edge and the probe's face, in the probe's frame.
std::vector<ColouredMesh> MomentView::outline() const {
  constexpr int kSteps = 12;
  std::vector<ColouredMesh> out;
  std::vector<std::pair<Vec3, Vec3>> lines;
  for (int i = 0; i <= kSteps; ++i) {
    const Scanline line = scanline(transducer_, i * (transducer_.n_lines - 1) / kSteps);
    lines.emplace_back(line.origin, line.origin + depth_ * line.direction);
  }
  const double half = 0.5 * transducer_.elevation_height;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    out.push_back(tube(lines[i - 1].second, lines[i].second, kThin, picture_colour()));
    for (const double y : {-half, half})
      out.push_back(tube(lines[i - 1].first + Vec3(0, y, 0), lines[i].first + Vec3(0, y, 0),
                         2 * kThin, face_colour()));
  }
  for (const auto& [top, bottom] : {lines.front(), lines.back()}) {
    out.push_back(tube(top, bottom, kThin, picture_colour()));
    out.push_back(tube(top - Vec3(0, half, 0), top + Vec3(0, half, 0), 2 * kThin, face_colour()));
  }
  return out;
}

/// The shaft as far as the drawing reaches, its tip, and how far that is beside the plane.
void MomentView::add_needle(const Pose& X_PN, const Eigen::AlignedBox3d& around,
                            std::vector<ColouredMesh>& meshes) const {
  const Vec3 tip = X_PN.translation();
  if (!around.contains(tip)) return;
  constexpr double kStep = 1e-3;  // m
  double length = 0;
  while (length + kStep <= length_ && around.contains(X_PN * Vec3(0, 0, -(length + kStep))))
    length += kStep;
  if (length > 0) meshes.push_back(tube(X_PN * Vec3(0, 0, -length), tip, kShaft, needle_colour()));
  meshes.push_back(ball(tip, kSphere, tip_colour()));
  const Vec3 shown(tip.x(), 0, tip.z());
  if (std::abs(tip.y()) > kSphere) meshes.push_back(tube(tip, shown, kThin, tip_colour()));
}

cv::Mat MomentView::draw(const Pose& X_JP, const std::optional<Pose>& X_JN, cv::Size size) const {
  const Pose X_PJ = X_JP.inverse();
  const double half = 0.5 * transducer_.width + kBeside;
  const Eigen::AlignedBox3d behind(Vec3(-half, -kBehind, -0.5 * kBeside),
                                   Vec3(half, 1e-3, depth_ + kBeside));
  const Eigen::AlignedBox3d around(Vec3(-half, -kBehind, -kBehind),
                                   Vec3(half, kBehind, depth_ + kBeside));
  std::vector<ColouredMesh> meshes = outline();
  meshes.push_back(corners_of({Vec3(-half, -kBeside, -kBeside), Vec3(half, kBeside, depth_)}));
  for (const ColouredMesh& mesh : body_) meshes.push_back(cut(mesh, X_PJ, behind));
  if (X_JN) add_needle(X_PJ * *X_JN, around, meshes);
  constexpr double kTurned = 40 * kDegree;
  constexpr double kRaised = 25 * kDegree;
  MeshView view;
  view.right = Vec3(std::cos(kTurned), -std::sin(kTurned), 0);
  const Vec3 toward(std::cos(kRaised) * std::sin(kTurned), std::cos(kRaised) * std::cos(kTurned),
                    -std::sin(kRaised));
  view.up = toward.cross(view.right);
  return draw_meshes(meshes, view, size);
}

}  // namespace artus
