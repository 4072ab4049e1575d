// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/joint3d/joint_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <epoxy/gl.h>

#include "artus/detail/viewer/joint3d/colours.h"
#include "artus/detail/viewer/joint3d/joint_shaders.h"

namespace artus {
namespace {

constexpr float kOpaque = 0.99F;
constexpr double kFarthest = 4.0;  // m from the eye that is still drawn

/// A plane that hides nothing.
Eigen::Vector4f no_plane() {
  return {0, 0, 0, 1};
}

}  // namespace

Vec3 eye_of(const OrbitCamera& c) {
  const Vec3 forward = c.up.cross(c.side).normalized();
  return c.centre +
         c.distance * (std::cos(c.pitch) * (std::sin(c.yaw) * c.side - std::cos(c.yaw) * forward) +
                       std::sin(c.pitch) * c.up);
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

namespace {

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

Result<std::unique_ptr<JointView>> JointView::make(std::shared_ptr<const CompiledJoint> joint,
                                                   double probe_width, double needle_length,
                                                   std::shared_ptr<const OutsideBody> outside) {
  auto solid = GlProgram::make(kSolidVertex, kSolidFragment);
  ARTUS_TRY(solid);
  auto picture = GlProgram::make(kPictureVertex, kPictureFragment);
  ARTUS_TRY(picture);
  std::unique_ptr<JointView> view(new JointView(std::move(joint), std::move(*solid),
                                                std::move(*picture), probe_width, needle_length));
  if (outside) ARTUS_TRY(view->show_outside(std::move(outside)));
  return view;
}

JointView::JointView(std::shared_ptr<const CompiledJoint> joint, GlProgram solid, GlProgram picture,
                     double probe_width, double needle_length)
    : joint_(std::move(joint)),
      solid_(std::move(solid)),
      picture_(std::move(picture)),
      probe_width_(probe_width),
      needle_length_(needle_length) {
  find_parts();
  find_centres();
  for (Sheet& sheet : find_sheets(*joint_)) sheets_.push_back({std::move(sheet), false, {}});
  const Pose& X_JP = joint_->X_JP_default;
  camera_.centre = X_JP * Vec3(0, 0, 15e-3);
  camera_.up = -X_JP.linear().col(2);
  camera_.side = X_JP.linear().col(0);
  camera_.yaw = -1.15;
  camera_.pitch = 0.5;
  set_box(box_);
  set_frustum(rod_, 1, 1);
  set_frustum(cone_, 1, 0);
  set_quad(quad_);
}

// The regions that have a surface, and how their tissues are drawn at first.
void JointView::find_parts() {
  const CompiledJoint& joint = *joint_;
  const std::vector<Rgb> palette = region_colours(joint);
  std::map<std::string, std::size_t> look_of;
  std::vector<bool> seen(joint.regions.size(), false);
  for (const Interface& face : joint.mesh.interfaces) seen[face.front] = seen[face.back] = true;
  part_of_.assign(joint.regions.size(), kNoPart);
  for (std::size_t r = kFirstRegion; r < joint.regions.size(); ++r) {
    if (!seen[r]) continue;
    const Tissue& tissue = joint.tissue_of(static_cast<RegionId>(r));
    const auto [place, fresh] = look_of.try_emplace(tissue.name, looks_.size());
    if (fresh) {
      looks_.push_back(
          {tissue.name, look_colour(palette[r]), usual_alpha(tissue.acoustic.kind), true});
    }
    part_of_[r] = parts_.size();
    parts_.push_back({place->second, joint.regions[r].name});
  }
}

// The mean of each part's corners, and which of them is the nearest to it.
void JointView::find_centres() {
  const TetMesh& mesh = joint_->mesh;
  const auto for_each_corner = [&](const auto& act) {
    for (const Interface& face : mesh.interfaces)
      for (const RegionId region : {face.front, face.back})
        if (part_of_[region] != kNoPart)
          for (const std::uint32_t v : face.vertices) act(part_of_[region], v);
  };
  std::vector<double> counts(parts_.size(), 0);
  for_each_corner([&](std::size_t part, std::uint32_t v) {
    parts_[part].centre += mesh.vertices[v];
    counts[part] += 1;
  });
  for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i].centre /= counts[i];
  std::vector<double> least(parts_.size(), std::numeric_limits<double>::infinity());
  for_each_corner([&](std::size_t part, std::uint32_t v) {
    const double distance = (mesh.vertices[v] - parts_[part].centre).squaredNorm();
    if (distance >= least[part]) return;
    least[part] = distance;
    parts_[part].nearest = v;
  });
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
std::optional<JointView::Step> JointView::opaque_step(DrawnSheet& sheet) const {
  Side front = side_of(sheet.sheet.front);
  Side back = side_of(sheet.sheet.back);
  const bool in_front = front.colour.w() > kOpaque;
  const bool in_back = back.colour.w() > kOpaque;
  if (!in_front && !in_back) return std::nullopt;
  front.lit = !in_front;
  back.lit = !in_back;
  if (!in_front) front.colour = back.colour;
  if (!in_back) back.colour = front.colour;
  return Step{&sheet, front, back, false};
}

// Opaque sheets, then what one looks through: the denser and the farther first.
void JointView::plan_steps() {
  struct Veil {
    Step step;
    double distance;
  };
  steps_.clear();
  std::vector<Veil> veils;
  const auto plan = [&](DrawnSheet& sheet) {
    if (const auto step = opaque_step(sheet)) {
      steps_.push_back(*step);
      return;
    }
    const double distance = (sheet.sheet.centre - eye_).squaredNorm();
    for (const RegionId region : {sheet.sheet.front, sheet.sheet.back}) {
      const Side side = side_of(region);
      if (side.colour.w() > 0) veils.push_back({{&sheet, side, side, true}, distance});
    }
  };
  for (DrawnSheet& sheet : sheets_) plan(sheet);
  for (DrawnSheet& sheet : injected_) plan(sheet);
  std::stable_sort(veils.begin(), veils.end(), [](const Veil& a, const Veil& b) {
    const float dense_a = a.step.front.colour.w();
    const float dense_b = b.step.front.colour.w();
    return dense_a != dense_b ? dense_a > dense_b : a.distance > b.distance;
  });
  for (const Veil& veil : veils) steps_.push_back(veil.step);
  next_step_ = 0;
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
  const bool same = !sight_.changed(scene.body) && now == seen_;
  seen_ = std::move(now);
  return !same;
}

unsigned JointView::draw(int width, int height, const JointScene& scene) {
  drew_ = false;
  const auto begin = Clock::now();
  if (!making_ && moved(width, height, scene)) {
    took_ = 0;
    begin_picture(width, height, scene);
    making_ = true;
  }
  if (making_) go_on(begin);
  return shown_ ? targets_[*shown_].texture() : 0;
}

// The clock is looked at between bundles of sheets: waiting for the graphics costs, too.
void JointView::go_on(Clock::time_point begin) {
  constexpr std::size_t kBundle = 30000;      // triangles
  constexpr std::size_t kWorthOfSheet = 500;  // triangles that asking for a sheet costs as much as
  const auto since = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  targets_[1 - shown_.value_or(1)].resume();
  begin_sheets(plane_);
  double built = 0;  // s; meshes are made once: no part of what a picture takes
  std::size_t bundle = 0;
  for (; next_step_ < steps_.size(); ++next_step_) {
    if (bundle > kBundle) {
      glFinish();
      bundle = 0;
    }
    if (bundle == 0 && since(begin) > (shown_ ? kRequestedTime : kFirstTime)) break;
    const Step& step = steps_[next_step_];
    const auto before = Clock::now();
    const GlMesh& mesh = mesh_of(*step.sheet);
    const double took = since(before);
    built += took;
    if (took > 1e-3) bundle = kBundle;
    glDepthMask(step.veil ? GL_FALSE : GL_TRUE);
    set_sides(step.front, step.behind);
    mesh.draw_triangles();
    bundle += mesh.n_triangles() + kWorthOfSheet;
  }
  glDepthMask(GL_TRUE);
  const bool done = next_step_ == steps_.size();
  if (done) {
    solid_.set("plane", no_plane());
    if (now_.input.device.has_needle != 0) draw_forces(making_view_, now_);
  }
  glDisable(GL_DEPTH_TEST);
  targets_[0].end();
  glFinish();
  took_ += since(begin) - built;
  if (!done) return;
  making_ = false;
  drew_ = true;
  shown_ = 1 - shown_.value_or(1);
  view_ = making_view_;
  image_shown_ = image_;
  points_sent_ = sending_;
  for (Part& part : parts_) part.shown = part.making;
  body_ = {};
  detail_.note(took_);
}

std::vector<ScreenLabel> JointView::labels(int width, int height) const {
  std::vector<ScreenLabel> found;
  for (const Part& part : parts_) {
    const TissueLook& look = looks_[part.look];
    if (!look.visible || look.alpha < 0.3F || part.name.empty()) continue;
    if (const auto label = on_screen(part.name, part.shown, width, height)) found.push_back(*label);
  }
  return found;
}

// Tools, the trail and the image plane, which cost little, and the plan of the rest.
void JointView::begin_picture(int width, int height, const JointScene& scene) {
  now_ = scene.now;
  image_ = scene.image == nullptr ? 0 : scene.image->input.number;
  take_body(scene.body);
  const OrbitCamera& c = camera_;
  eye_ = eye_of(c);
  making_view_ = perspective(0.7, static_cast<double>(width) / height, 0.01, kFarthest) *
                 look_at(eye_, c.centre, c.up);
  const int share = DetailChooser::kPixels[detail_.level()];
  targets_[1 - shown_.value_or(1)].begin(width / share, height / share);
  glClearColor(0.09F, 0.10F, 0.12F, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  begin_sheets(no_plane());
  draw_tools(making_view_, scene);
  draw_outside(making_view_, eye_, false);
  draw_trail(making_view_, scene.X_JN);
  if (scene.image != nullptr) draw_image(making_view_, *scene.image, scene.image_texture);
  if (scene.entry) draw_entry(making_view_, *scene.entry);
  plane_ = no_plane();
  if (cut_away) {
    const Pose X_JP = to_pose(now_.X_JP);
    Vec3 normal = X_JP.linear().col(1);
    if (normal.dot(eye_ - X_JP.translation()) < 0) normal = -normal;
    plane_ << normal.cast<float>(), static_cast<float>(normal.dot(X_JP.translation()));
  }
  plan_steps();
  move_to_body();
}

// How surfaces are drawn, whatever was drawn elsewhere since.
void JointView::begin_sheets(const Eigen::Vector4f& plane) {
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  solid_.use();
  Eigen::Vector4f eye;
  eye << eye_.cast<float>(), 1.F;
  solid_.set("eye", eye);
  solid_.set("plane", plane);
  solid_.set("view", making_view_);
  solid_.set("model", Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
}

}  // namespace artus
