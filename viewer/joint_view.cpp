// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/joint_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <epoxy/gl.h>

#include "artus/echo/labels.h"

namespace artus {
namespace {

constexpr const char* kSolidVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 view; uniform mat4 model; uniform vec4 plane;
out vec3 place; out float ahead;
void main() {
  vec4 p = model * vec4(position, 1.0);
  place = p.xyz;
  ahead = dot(plane.xyz, p.xyz) - plane.w;
  gl_Position = view * p;
})";
constexpr const char* kSolidFragment = R"(#version 330 core
in vec3 place; in float ahead;
uniform vec4 colour; uniform vec4 eye; uniform int lit;
out vec4 result;
void main() {
  if (ahead > 0.0) discard;
  float shade = 1.0;
  if (lit == 1) {
    vec3 n = normalize(cross(dFdx(place), dFdy(place)));
    shade = 0.3 + 0.7 * abs(dot(n, normalize(eye.xyz - place)));
  }
  result = vec4(shade * colour.rgb, colour.a);
})";
constexpr const char* kPictureVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 view; uniform mat4 model;
out vec2 uv;
void main() { uv = position.xy; gl_Position = view * model * vec4(position, 1.0); })";
constexpr const char* kPictureFragment = R"(#version 330 core
in vec2 uv; uniform sampler2D image; out vec4 result;
void main() { result = vec4(texture(image, uv).rrr, 1.0); })";

/// A plane that hides nothing.
Eigen::Vector4f no_plane() {
  return {0, 0, 0, 1};
}

Eigen::Matrix4f look_at(const Vec3& eye, const Vec3& centre, const Vec3& up) {
  const Vec3 z = (eye - centre).normalized();
  const Vec3 x = up.cross(z).normalized();
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<1, 3>(0, 0) = x.transpose();
  m.block<1, 3>(1, 0) = z.cross(x).transpose();
  m.block<1, 3>(2, 0) = z.transpose();
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * eye;
  return m.cast<float>();
}

Eigen::Matrix4f perspective(double height_angle, double aspect, double near, double far) {
  const double f = 1 / std::tan(height_angle / 2);
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = f / aspect;
  m(1, 1) = f;
  m(2, 2) = (far + near) / (near - far);
  m(2, 3) = 2 * far * near / (near - far);
  m(3, 2) = -1;
  return m.cast<float>();
}

Eigen::Matrix4f to_model(const Pose& pose, const Vec3& scale) {
  Eigen::Matrix4d m = pose.matrix();
  for (int i = 0; i < 3; ++i) m.col(i) *= scale[i];
  return m.cast<float>();
}

/// A body of revolution about z from 0 to 1: radius `bottom` at 0, `top` at 1.
void set_frustum(GlMesh& mesh, float bottom, float top) {
  constexpr std::uint32_t kSides = 20;
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const float a = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSides;
    points.emplace_back(bottom * std::cos(a), bottom * std::sin(a), 0.F);
    points.emplace_back(top * std::cos(a), top * std::sin(a), 1.F);
    const std::uint32_t j = (i + 1) % kSides;
    indices.insert(indices.end(), {2 * i, 2 * j, 2 * i + 1, 2 * j, 2 * j + 1, 2 * i + 1});
  }
  mesh.set_points(points);
  mesh.set_triangles(indices);
}

void set_box(GlMesh& mesh) {
  std::array<Eigen::Vector3f, 8> points;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {(i & 1) != 0 ? 0.5F : -0.5F, (i & 2) != 0 ? 0.5F : -0.5F,
                 (i & 4) != 0 ? 0.F : -1.F};
  const std::array<std::uint32_t, 36> indices{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                              2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  mesh.set_points(points);
  mesh.set_triangles(indices);
}

void set_quad(GlMesh& mesh) {
  const std::array<Eigen::Vector3f, 4> points{Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 0, 0),
                                              Eigen::Vector3f(1, 1, 0), Eigen::Vector3f(0, 1, 0)};
  const std::array<std::uint32_t, 6> indices{0, 1, 2, 0, 2, 3};
  mesh.set_points(points);
  mesh.set_triangles(indices);
}

float usual_alpha(TissueKind kind) {
  switch (kind) {
    case TissueKind::skin:
      return 0.15F;
    case TissueKind::fat:
      return 0.12F;
    case TissueKind::muscle:
      return 0.55F;
    default:
      return 1.F;
  }
}

}  // namespace

Result<std::unique_ptr<JointView>> JointView::make(const CompiledJoint& joint, double probe_width,
                                                   double needle_length) {
  auto solid = GlProgram::make(kSolidVertex, kSolidFragment);
  ARTUS_TRY(solid);
  auto picture = GlProgram::make(kPictureVertex, kPictureFragment);
  ARTUS_TRY(picture);
  return std::unique_ptr<JointView>(
      new JointView(joint, std::move(*solid), std::move(*picture), probe_width, needle_length));
}

JointView::JointView(const CompiledJoint& joint, GlProgram solid, GlProgram picture,
                     double probe_width, double needle_length)
    : solid_(std::move(solid)),
      picture_(std::move(picture)),
      probe_width_(probe_width),
      needle_length_(needle_length) {
  const auto palette = region_palette(joint);
  std::map<std::string, std::size_t> look_of;
  std::vector<std::vector<std::uint32_t>> triangles(joint.regions.size());
  for (const Interface& face : joint.mesh.interfaces) {
    for (const RegionId region : {face.front, face.back}) {
      if (region < kFirstRegion) continue;
      auto& list = triangles[region];
      list.insert(list.end(), face.vertices.begin(), face.vertices.end());
    }
  }
  for (std::size_t r = kFirstRegion; r < joint.regions.size(); ++r) {
    if (triangles[r].empty()) continue;
    const Tissue& tissue = joint.tissue_of(static_cast<RegionId>(r));
    const auto [place, fresh] = look_of.try_emplace(tissue.name, looks_.size());
    if (fresh) {
      const auto& c = palette[r];
      looks_.push_back({tissue.name,
                        Eigen::Vector3f(static_cast<float>(c[0]), static_cast<float>(c[1]),
                                        static_cast<float>(c[2])) /
                            255.F,
                        usual_alpha(tissue.acoustic.kind), true});
    }
    // Each part has its own points, so that a part is one small draw.
    std::map<std::uint32_t, std::uint32_t> renumbered;
    std::vector<Eigen::Vector3f> points;
    for (std::uint32_t& v : triangles[r]) {
      const auto [at, is_new] =
          renumbered.try_emplace(v, static_cast<std::uint32_t>(points.size()));
      if (is_new) points.emplace_back(joint.mesh.vertices[v].cast<float>());
      v = at->second;
    }
    Vec3 centre = Vec3::Zero();
    for (const auto& p : points) centre += p.cast<double>() / static_cast<double>(points.size());
    GlMesh mesh;
    mesh.set_points(points);
    mesh.set_triangles(triangles[r]);
    parts_.push_back({place->second, centre, std::move(mesh)});
  }
  camera_.centre = joint.X_JP_default * Vec3(0, 0, 15e-3);
  camera_.up = -joint.X_JP_default.linear().col(2);
  camera_.side = joint.X_JP_default.linear().col(0);
  camera_.yaw = -1.15;
  camera_.pitch = 0.5;
  set_box(box_);
  set_frustum(rod_, 1, 1);
  set_frustum(cone_, 1, 0);
  set_quad(quad_);
}

void JointView::draw_mesh(const GlMesh& mesh, const Eigen::Matrix4f& view,
                          const Eigen::Matrix4f& model, const Eigen::Vector4f& colour, bool lit) {
  solid_.set("view", view);
  solid_.set("model", model);
  solid_.set("colour", colour);
  solid_.set("lit", lit ? 1 : 0);
  mesh.draw_triangles();
}

void JointView::draw_parts(const Eigen::Matrix4f& view, const Eigen::Vector4f& plane) {
  solid_.set("plane", plane);
  std::vector<const Part*> order;
  for (const Part& part : parts_) {
    const TissueLook& look = looks_[part.look];
    if (look.visible && look.alpha > 0.01F) order.push_back(&part);
  }
  const auto opaque = [&](const Part* p) {
    return looks_[p->look].alpha > 0.99F;
  };
  std::stable_sort(order.begin(), order.end(), [&](const Part* a, const Part* b) {
    if (opaque(a) != opaque(b)) return opaque(a);
    if (looks_[a->look].alpha != looks_[b->look].alpha)
      return looks_[a->look].alpha > looks_[b->look].alpha;
    return (a->centre - eye_).squaredNorm() > (b->centre - eye_).squaredNorm();
  });
  for (const Part* part : order) {
    const TissueLook& look = looks_[part->look];
    glDepthMask(opaque(part) ? GL_TRUE : GL_FALSE);
    Eigen::Vector4f colour;
    colour << look.colour, look.alpha;
    draw_mesh(part->mesh, view, Eigen::Matrix4f::Identity(), colour, true);
  }
  glDepthMask(GL_TRUE);
  solid_.set("plane", no_plane());
}

void JointView::draw_tools(const Eigen::Matrix4f& view, const HapticSnapshot& now) {
  const Pose X_JP = to_pose(now.X_JP);
  draw_mesh(box_, view, to_model(X_JP, Vec3(probe_width_, 10e-3, 30e-3)), {0.85F, 0.88F, 0.95F, 1},
            true);
  if (now.input.device.has_needle == 0) return;
  const Pose X_JN = to_pose(now.X_JN);
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

void JointView::draw_trail(const Eigen::Matrix4f& view, const HapticSnapshot& now) {
  const Eigen::Vector3f tip = to_pose(now.X_JN).translation().cast<float>();
  constexpr std::size_t kLongest = 2000;
  if (trail_.empty() || (trail_.back() - tip).norm() > 0.2e-3F) trail_.push_back(tip);
  if (trail_.size() > kLongest) trail_.pop_front();
  const std::vector<Eigen::Vector3f> points(trail_.begin(), trail_.end());
  line_.set_points(points);
  solid_.set("view", view);
  solid_.set("model", Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
  solid_.set("colour", Eigen::Vector4f(0.2F, 1.F, 0.5F, 1.F));
  solid_.set("lit", 0);
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

unsigned JointView::draw(int width, int height, const JointScene& scene) {
  const HapticSnapshot& now = scene.now;
  const OrbitCamera& c = camera_;
  const Vec3 forward = c.up.cross(c.side).normalized();
  eye_ = c.centre +
         c.distance * (std::cos(c.pitch) * (std::sin(c.yaw) * c.side - std::cos(c.yaw) * forward) +
                       std::sin(c.pitch) * c.up);
  const Eigen::Matrix4f view = perspective(0.7, static_cast<double>(width) / height, 0.01, 2.0) *
                               look_at(eye_, c.centre, c.up);
  target_.begin(width, height);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glClearColor(0.09F, 0.10F, 0.12F, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  solid_.use();
  Eigen::Vector4f eye;
  eye << eye_.cast<float>(), 1.F;
  solid_.set("eye", eye);
  solid_.set("plane", no_plane());
  draw_tools(view, now);
  draw_trail(view, now);
  if (scene.image != nullptr) draw_image(view, *scene.image, scene.image_texture);
  if (scene.entry) draw_entry(view, *scene.entry);
  Eigen::Vector4f plane = no_plane();
  if (cut_away) {
    const Pose X_JP = to_pose(now.X_JP);
    Vec3 normal = X_JP.linear().col(1);
    if (normal.dot(eye_ - X_JP.translation()) < 0) normal = -normal;
    plane << normal.cast<float>(), static_cast<float>(normal.dot(X_JP.translation()));
  }
  draw_parts(view, plane);
  if (now.input.device.has_needle != 0) draw_forces(view, now);
  glDisable(GL_DEPTH_TEST);
  target_.end();
  return target_.texture();
}

}  // namespace artus
