// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/joint_view.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include <epoxy/gl.h>

#include "artus/viewer/colours.h"
#include "artus/viewer/joint_shaders.h"

namespace artus {
namespace {

constexpr float kOpaque = 0.99F;

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
  find_parts(joint);
  for (Sheet& sheet : find_sheets(joint)) sheets_.push_back({std::move(sheet), {}});
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

// The regions that have a surface, and how their tissues are drawn at first.
void JointView::find_parts(const CompiledJoint& joint) {
  const std::vector<Rgb> palette = region_colours(joint);
  std::map<std::string, std::size_t> look_of;
  std::vector<Vec3> sums(joint.regions.size(), Vec3::Zero());
  std::vector<double> counts(joint.regions.size(), 0);
  for (const Interface& face : joint.mesh.interfaces) {
    for (const RegionId region : {face.front, face.back}) {
      for (const std::uint32_t v : face.vertices) sums[region] += joint.mesh.vertices[v];
      counts[region] += 3;
    }
  }
  part_of_.assign(joint.regions.size(), kNoPart);
  for (std::size_t r = kFirstRegion; r < joint.regions.size(); ++r) {
    if (counts[r] == 0) continue;
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
    part_of_[r] = parts_.size();
    parts_.push_back({place->second, joint.regions[r].name, sums[r] / counts[r]});
  }
}

const GlMesh& JointView::mesh_of(DrawnSheet& sheet) {
  std::unique_ptr<GlMesh>& mesh = sheet.meshes[detail_.level()];
  if (!mesh) {
    const Surface surface = decimated(sheet.sheet.surface, DetailChooser::kCells[detail_.level()]);
    mesh = std::make_unique<GlMesh>();
    mesh->set_points(surface.points);
    mesh->set_triangles(surface.indices);
  }
  return *mesh;
}

void JointView::draw_mesh(const GlMesh& mesh, const Eigen::Matrix4f& view,
                          const Eigen::Matrix4f& model, const Eigen::Vector4f& colour, bool lit) {
  solid_.set("view", view);
  solid_.set("model", model);
  set_sides({colour, lit}, {colour, lit});
  mesh.draw_triangles();
}

void JointView::set_sides(const Side& front, const Side& behind) {
  solid_.set("colour", front.colour);
  solid_.set("behind", behind.colour);
  solid_.set("lit", front.lit ? 1 : 0);
  solid_.set("lit_behind", behind.lit ? 1 : 0);
}

JointView::Side JointView::side_of(RegionId region) const {
  Side side{Eigen::Vector4f::Zero(), true};
  if (part_of_[region] == kNoPart) return side;
  const TissueLook& look = looks_[parts_[part_of_[region]].look];
  if (look.visible && look.alpha > 0.01F) side.colour << look.colour, look.alpha;
  return side;
}

// Who looks at a sheet from within an opaque structure does so because this one was cut open, and
// sees the cut's plain colour; else the surface of what lies behind the sheet.
void JointView::draw_opaque(DrawnSheet& sheet) {
  Side front = side_of(sheet.sheet.front);
  Side back = side_of(sheet.sheet.back);
  const bool in_front = front.colour.w() > kOpaque;
  const bool in_back = back.colour.w() > kOpaque;
  if (!in_front && !in_back) return;
  front.lit = !in_front;
  back.lit = !in_back;
  if (!in_front) front.colour = back.colour;
  if (!in_back) back.colour = front.colour;
  set_sides(front, back);
  mesh_of(sheet).draw_triangles();
}

void JointView::draw_parts(const Eigen::Matrix4f& view, const Eigen::Vector4f& plane) {
  solid_.set("plane", plane);
  solid_.set("view", view);
  solid_.set("model", Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
  struct Veil {
    DrawnSheet* sheet;
    Eigen::Vector4f colour;
    double distance;
  };
  std::vector<Veil> veils;
  for (DrawnSheet& sheet : sheets_) {
    draw_opaque(sheet);
    const Eigen::Vector4f front = side_of(sheet.sheet.front).colour;
    const Eigen::Vector4f back = side_of(sheet.sheet.back).colour;
    if (front.w() > kOpaque || back.w() > kOpaque) continue;
    for (const Eigen::Vector4f& colour : {front, back})
      if (colour.w() > 0)
        veils.push_back({&sheet, colour, (sheet.sheet.centre - eye_).squaredNorm()});
  }
  std::stable_sort(veils.begin(), veils.end(), [](const Veil& a, const Veil& b) {
    return a.colour.w() != b.colour.w() ? a.colour.w() > b.colour.w() : a.distance > b.distance;
  });
  glDepthMask(GL_FALSE);
  for (const Veil& veil : veils) {
    set_sides({veil.colour, true}, {veil.colour, true});
    mesh_of(*veil.sheet).draw_triangles();
  }
  glDepthMask(GL_TRUE);
  solid_.set("plane", no_plane());
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

// All that the picture depends on, rounded to what a person could see; the speckle in the image
// plane is no motion.
bool JointView::moved(int width, int height, const JointScene& scene) {
  std::vector<double> now{static_cast<double>(width), static_cast<double>(height),
                          static_cast<double>(detail_.level()), cut_away ? 1.0 : 0.0,
                          static_cast<double>(scene.now.inserted)};
  const auto add = [&now](double value, double step) {
    now.push_back(std::round(value / step));
  };
  const auto add_pose = [&add](const Pose& pose) {
    for (int i = 0; i < 3; ++i) add(pose.translation()[i], 0.05e-3);
    for (int i = 0; i < 9; ++i) add(pose.linear()(i / 3, i % 3), 1e-3);
  };
  add_pose(to_pose(scene.now.X_JP));
  add_pose(scene.X_JN);
  for (int i = 0; i < 3; ++i) {
    add(scene.now.force_J[i], 0.05);
    add(scene.now.torque_J[i], 2e-3);
  }
  add(scene.now.cone, 0.01);
  for (const double value : {camera_.yaw, camera_.pitch, camera_.distance}) add(value, 1e-4);
  for (const TissueLook& look : looks_) {
    add(look.alpha, 0.01);
    add(look.visible ? 1 : 0, 1);
  }
  if (scene.image != nullptr) {
    add_pose(to_pose(scene.image->input.X_JP));
    add_pose(to_pose(scene.image->input.X_JN));
    const ImageControls& c = scene.image->input.controls;
    for (const double value : {c.depth, c.gain_db, c.dynamic_range_db, c.tgc_db_cm_mhz})
      add(value, 1e-4);
    add(scene.image->width, 1);
  }
  add(scene.entry ? 1 : 0, 1);
  if (scene.entry)
    for (int i = 0; i < 3; ++i) add(scene.entry->p_J[i], 0.1e-3);
  const bool same = now == seen_;
  seen_ = std::move(now);
  return !same;
}

unsigned JointView::draw(int width, int height, const JointScene& scene) {
  drew_ = moved(width, height, scene);
  if (!drew_) return target_.texture();
  for (DrawnSheet& sheet : sheets_) mesh_of(sheet);  // made once: no part of what a picture takes
  const auto begin = std::chrono::steady_clock::now();
  draw_all(width, height, scene);
  glFinish();
  detail_.note(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  return target_.texture();
}

std::vector<ScreenLabel> JointView::labels(int width, int height) const {
  std::vector<ScreenLabel> found;
  for (const Part& part : parts_) {
    const TissueLook& look = looks_[part.look];
    if (!look.visible || look.alpha < 0.3F) continue;
    Eigen::Vector4f p;
    p << part.centre.cast<float>(), 1.F;
    const Eigen::Vector4f q = view_ * p;
    if (q.w() <= 0 || std::abs(q.x()) > q.w() || std::abs(q.y()) > q.w()) continue;
    const ScreenLabel label{part.name, 0.5F * (1 + q.x() / q.w()) * static_cast<float>(width),
                            0.5F * (1 - q.y() / q.w()) * static_cast<float>(height)};
    found.push_back(label);
  }
  return found;
}

void JointView::draw_all(int width, int height, const JointScene& scene) {
  const HapticSnapshot& now = scene.now;
  const OrbitCamera& c = camera_;
  const Vec3 forward = c.up.cross(c.side).normalized();
  eye_ = c.centre +
         c.distance * (std::cos(c.pitch) * (std::sin(c.yaw) * c.side - std::cos(c.yaw) * forward) +
                       std::sin(c.pitch) * c.up);
  view_ = perspective(0.7, static_cast<double>(width) / height, 0.01, 2.0) *
          look_at(eye_, c.centre, c.up);
  const Eigen::Matrix4f& view = view_;
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
  draw_tools(view, scene);
  draw_trail(view, scene.X_JN);
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
}

}  // namespace artus
