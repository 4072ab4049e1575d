// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>

#include "artus/detail/viewer/joint3d/joint_view.h"

namespace artus {
namespace {

Eigen::Matrix4f to_model(const Pose& pose, const Vec3& scale) {
  Eigen::Matrix4d m = pose.matrix();
  for (int i = 0; i < 3; ++i) m.col(i) *= scale[i];
  return m.cast<float>();
}

}  // namespace

void JointView::draw_mesh(const GlMesh& mesh, const Eigen::Matrix4f& view,
                          const Eigen::Matrix4f& model, const Eigen::Vector4f& colour, bool lit) {
  solid_.set("view", view);
  solid_.set("model", model);
  set_sides({colour, lit}, {colour, lit});
  mesh.draw_triangles();
}

void JointView::draw_tools(const Eigen::Matrix4f& view, const JointScene& scene) {
  const HapticSnapshot& now = scene.now;
  const Pose X_JP = to_pose(now.X_JP);
  // The marked side, where the picture's dot is.
  const Pose mark = X_JP * Eigen::Translation3d(-probe_width_ / 2 - 1e-3, 0, -2e-3);
  draw_mesh(box_, view, to_model(mark, Vec3(3e-3, 4e-3, 10e-3)), {1.F, 0.86F, 0.35F, 1}, true);
  draw_mesh(box_, view, to_model(X_JP, Vec3(probe_width_, 10e-3, 30e-3)), {0.85F, 0.88F, 0.95F, 1},
            true);
  if (now.input.device.has_needle == 0) return;
  const Pose& X_JN = scene.X_JN;
  const Pose shaft = X_JN * Eigen::Translation3d(0, 0, -needle_length_);
  draw_mesh(rod_, view, to_model(shaft, Vec3(0.6e-3, 0.6e-3, needle_length_)),
            {1.F, 0.95F, 0.4F, 1}, true);
  const Pose hub = shaft * Eigen::Translation3d(0, 0, -25e-3);
  draw_mesh(rod_, view, to_model(hub, Vec3(4e-3, 4e-3, 25e-3)), {0.6F, 0.8F, 0.9F, 1}, true);
}

void JointView::draw_forces(const Eigen::Matrix4f& view, const HapticSnapshot& now) {
  const Pose X_JN = to_pose(now.X_JN);
  const Vec3 tip = X_JN.translation();
  const auto arrow = [&](const Vec3& vector, double length, const Eigen::Vector4f& colour) {
    if (length < 1e-3) return;
    const Pose at = make_pose(tip - 40e-3 * X_JN.linear().col(2), vector, Vec3::UnitX());
    draw_mesh(rod_, view, to_model(at, Vec3(0.8e-3, 0.8e-3, length)), colour, true);
    const Pose head = at * Eigen::Translation3d(0, 0, length);
    draw_mesh(cone_, view, to_model(head, Vec3(2e-3, 2e-3, 5e-3)), colour, true);
  };
  const Vec3 force(now.force_J[0], now.force_J[1], now.force_J[2]);
  const Vec3 torque(now.torque_J[0], now.torque_J[1], now.torque_J[2]);
  arrow(force, 8e-3 * force.norm(), {1.F, 0.3F, 0.2F, 1});   // 8 mm for a newton
  arrow(torque, 0.2 * torque.norm(), {0.3F, 0.5F, 1.F, 1});  // 2 mm for 10 mN m
  if (now.inserted == 0) return;
  const Vec3 entry(now.entry_J[0], now.entry_J[1], now.entry_J[2]);
  constexpr double kLength = 25e-3;  // m of the cone that is drawn outside the skin
  const double radius = kLength * std::tan(std::min(now.cone, 1.4));
  const Vec3 outward = -X_JN.linear().col(2);
  const Pose base = make_pose(entry + kLength * outward, -outward, Vec3::UnitX());
  glDepthMask(GL_FALSE);
  draw_mesh(cone_, view, to_model(base, Vec3(radius, radius, kLength)), {1.F, 0.9F, 0.3F, 0.18F},
            false);
  glDepthMask(GL_TRUE);
}

void JointView::draw_image(const Eigen::Matrix4f& view, const ImageSnapshot& image,
                           const GlTexture& texture) {
  const double width = image.width * image.pixel;
  const double height = image.height * image.pixel;
  const Pose X_JP = to_pose(image.input.X_JP);
  Eigen::Matrix4d model = Eigen::Matrix4d::Identity();  // u along the lateral axis, v into the body
  model.block<3, 1>(0, 0) = width * X_JP.linear().col(0);
  model.block<3, 1>(0, 1) = height * X_JP.linear().col(2);
  model.block<3, 1>(0, 2) = X_JP.linear().col(1);
  model.block<3, 1>(0, 3) = X_JP * Vec3(-width / 2, 0, 0);
  picture_.use();
  picture_.set("view", view);
  picture_.set("model", Eigen::Matrix4f(model.cast<float>()));
  picture_.set("image", 0);
  glActiveTexture(GL_TEXTURE0);
  texture.bind();
  quad_.draw_triangles();
  solid_.use();
}

void JointView::draw_trail(const Eigen::Matrix4f& view, const Pose& X_JN) {
  const Eigen::Vector3f tip = X_JN.translation().cast<float>();
  constexpr std::size_t kLongest = 2000;
  if (trail_.empty() || (trail_.back() - tip).norm() > 0.2e-3F) trail_.push_back(tip);
  if (trail_.size() > kLongest) trail_.pop_front();
  const std::vector<Eigen::Vector3f> points(trail_.begin(), trail_.end());
  line_.set_points(points);
  solid_.set("view", view);
  solid_.set("model", Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
  const Eigen::Vector4f green(0.2F, 1.F, 0.5F, 1.F);
  set_sides({green, false}, {green, false});
  line_.draw_line_strip();
}

void JointView::draw_entry(const Eigen::Matrix4f& view, const EntryChoice& entry) {
  constexpr double kLength = 20e-3;  // m of the arrow outside the skin
  const Pose from =
      make_pose(entry.p_J - kLength * entry.direction_J, entry.direction_J, Vec3::UnitX());
  draw_mesh(rod_, view, to_model(from, Vec3(0.4e-3, 0.4e-3, kLength - 4e-3)), {0.4F, 1.F, 0.6F, 1},
            false);
  draw_mesh(cone_, view,
            to_model(from * Eigen::Translation3d(0, 0, kLength - 4e-3), Vec3(1.5e-3, 1.5e-3, 4e-3)),
            {0.4F, 1.F, 0.6F, 1}, false);
}

}  // namespace artus
