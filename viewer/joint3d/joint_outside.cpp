// SPDX-License-Identifier: AGPL-3.0-or-later
// The person around the joint.
#include <algorithm>
#include <cmath>
#include <utility>

#include <epoxy/gl.h>

#include "artus/detail/viewer/joint3d/free_view.h"
#include "artus/detail/viewer/joint3d/joint_shaders.h"
#include "artus/detail/viewer/joint3d/joint_view.h"

namespace artus {
namespace {

constexpr double kUsualDistance = 0.36;  // m from which a joint is seen with what is around it

std::vector<Eigen::Vector3f> in_floats(const std::vector<Vec3>& points) {
  std::vector<Eigen::Vector3f> out;
  out.reserve(points.size());
  for (const Vec3& p : points) out.emplace_back(p.cast<float>());
  return out;
}

std::vector<Eigen::Vector3f> smooth_normals(const SurfaceMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const auto& v = mesh.vertices;
    const Vec3 normal = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
    for (const std::uint32_t corner : t) normals[corner] += normal;
  }
  for (Vec3& n : normals) n.stableNormalize();
  return in_floats(normals);
}

}  // namespace

Result<void> JointView::show_outside(std::shared_ptr<const OutsideBody> outside) {
  auto program = GlProgram::make(kPersonVertex, kPersonFragment);
  ARTUS_TRY(program);
  person_.emplace(std::move(*program));
  outside_ = std::move(outside);
  std::vector<std::uint32_t> indices;
  for (const Triangle& t : outside_->skin.triangles)
    indices.insert(indices.end(), t.begin(), t.end());
  skin_.set_points(in_floats(outside_->skin.vertices));
  skin_.set_normals(smooth_normals(outside_->skin));
  skin_.set_triangles(indices);
  camera_.distance = kUsualDistance;
  if (outside_->hole) camera_ = find_free_view(*outside_, camera_);
  return {};
}

// What the person sits or lies on stays behind the joint: it is drawn where it cannot hide it.
void JointView::draw_outside(const Eigen::Matrix4f& view, const Vec3& eye, bool marked) {
  if (!outside_) return;
  Eigen::Vector4f hole = Eigen::Vector4f::Zero();
  Eigen::Vector4f half = Eigen::Vector4f::Zero();
  if (const auto& region = outside_->hole) {
    const double reach = region->half_extent ? region->half_extent->maxCoeff() : region->radius;
    hole << region->centre.cast<float>(), static_cast<float>(reach);
    if (region->half_extent) half << region->half_extent->cast<float>(), 1.F;
  }
  Eigen::Vector4f from;
  from << eye.cast<float>(), 1.F;
  person_->use();
  person_->set("view", view);
  person_->set("eye", from);
  person_->set("hole", hole);
  person_->set("half_extent", half);
  person_->set("marked", marked ? 1 : 0);
  person_->set("opened", cut_away ? 1 : 0);
  person_->set("colour", Eigen::Vector4f(0.93F, 0.76F, 0.65F, 1));
  skin_.draw_triangles();
  solid_.use();
  for (const Support& box : outside_->supports) {
    Eigen::Matrix4d model = (box.X_JS * Eigen::Translation3d(0, 0, box.half.z())).matrix();
    for (int i = 0; i < 3; ++i) model.col(i) *= 2 * box.half[i];
    draw_mesh(box_, view, model.cast<float>(), Eigen::Vector4f(0.25F, 0.30F, 0.36F, 1), true);
  }
}

std::optional<ScreenLabel> JointView::on_screen(std::string name, const Vec3& p, int width,
                                                int height) const {
  Eigen::Vector4f at;
  at << p.cast<float>(), 1.F;
  const Eigen::Vector4f q = view_ * at;
  if (q.w() <= 0 || std::abs(q.x()) > q.w() || std::abs(q.y()) > q.w()) return std::nullopt;
  return ScreenLabel{std::move(name), 0.5F * (1 + q.x() / q.w()) * static_cast<float>(width),
                     0.5F * (1 - q.y() / q.w()) * static_cast<float>(height)};
}

std::vector<ScreenLabel> JointView::landmarks(int width, int height) const {
  std::vector<ScreenLabel> found;
  if (!outside_) return found;
  for (const BodyLandmark& mark : outside_->landmarks) {
    if (mark.outward.dot(eye_ - mark.position) <= 0) continue;
    if (auto label = on_screen(mark.name, mark.position, width, height))
      found.push_back(std::move(*label));
  }
  return found;
}

std::vector<ScreenLabel> JointView::sides(int width, int height) const {
  std::vector<ScreenLabel> found;
  if (!outside_) return found;
  const auto add = [&](const char* letter, const std::vector<Vec3>& places) {
    for (const Vec3& p : places)
      if (auto label = on_screen(letter, p, width, height)) found.push_back(std::move(*label));
  };
  add("R", outside_->right);
  add("L", outside_->left);
  return found;
}

// A finger or a tip over a bone, square to the skin.
std::string JointView::felt_at(const Vec3& tip) const {
  constexpr double kBeside = 9e-3;  // m; assumed: half a fingertip
  constexpr double kAbove = 30e-3;  // m of skin and fat over a bone that is still felt; assumed
  std::string felt;
  double nearest = kBeside;
  if (!outside_) return felt;
  for (const BodyLandmark& mark : outside_->landmarks) {
    const Vec3 off = tip - mark.position;
    const double beside = off.cross(mark.outward).norm();
    const double above = off.dot(mark.outward);
    if (beside >= nearest || above < -kBeside || above > kAbove) continue;
    nearest = beside;
    felt = mark.name;
  }
  return felt;
}

// Upright, from the side on which the probe stands; where that is above, from that of the joint.
unsigned JointView::overview() {
  if (!outside_) return 0;
  if (overview_drawn_) return overview_.texture();
  overview_drawn_ = true;
  Vec3 low = Vec3::Constant(1e9);
  Vec3 high = -low;
  for (const Vec3& p : outside_->skin.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 centre = (low + high) / 2;
  const Vec3& up = outside_->up;
  Vec3 toward = -joint_->X_JP_default.linear().col(2);
  toward -= up.dot(toward) * up;
  if (toward.norm() < 0.5 && outside_->hole) {
    toward = outside_->hole->centre - centre;
    toward -= up.dot(toward) * up;
  }
  constexpr double kAngle = 0.5;  // rad
  const double tall = std::abs((high - low).dot(up.cwiseAbs()));
  const Vec3 eye = centre + 1.15 * tall / (2 * std::tan(kAngle / 2)) * toward.normalized();
  overview_.begin(kOverviewWidth, kOverviewHeight);
  glClearColor(0.05F, 0.06F, 0.07F, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  const Eigen::Matrix4f view =
      perspective(kAngle, static_cast<double>(kOverviewWidth) / kOverviewHeight, 0.1, 20) *
      look_at(eye, centre, up);
  solid_.use();
  Eigen::Vector4f from;
  from << eye.cast<float>(), 1.F;
  solid_.set("eye", from);
  solid_.set("plane", Eigen::Vector4f(0, 0, 0, 1));
  draw_outside(view, eye, true);
  glDisable(GL_DEPTH_TEST);
  overview_.end();
  return overview_.texture();
}

}  // namespace artus
