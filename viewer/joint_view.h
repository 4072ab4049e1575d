// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/session/session.h"
#include "artus/viewer/gl_objects.h"

namespace artus {

/// How one tissue is drawn.
struct TissueLook {
  std::string name;
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();  ///< red, green, blue, 0 to 1
  float alpha = 1;
  bool visible = true;
};

/// Where the joint is seen from.
struct OrbitCamera {
  Vec3 centre = Vec3::Zero();  ///< m, frame J
  double yaw = 0;              ///< rad
  double pitch = 0;            ///< rad
  double distance = 0.2;       ///< m
  Vec3 up = Vec3::UnitZ();
  Vec3 side = Vec3::UnitX();
};

/// What there is to draw besides the joint.
struct JointScene {
  const HapticSnapshot& now;
  const ImageSnapshot* image;  ///< null when there is none
  const GlTexture& image_texture;
  const std::optional<EntryChoice>& entry;  ///< where the needle would enter
};

/// The joint in three dimensions with probe, needle, image plane, insertion cone, forces and the
/// tip's trail. Draws frame J. Needs a current OpenGL 3.3 context for its whole life.
class JointView {
 public:
  [[nodiscard]] static Result<std::unique_ptr<JointView>> make(const CompiledJoint& joint,
                                                               double probe_width,
                                                               double needle_length);

  /// Draws into a picture of its own and returns its texture.
  unsigned draw(int width, int height, const JointScene& scene);

  std::vector<TissueLook>& looks() noexcept { return looks_; }
  OrbitCamera& camera() noexcept { return camera_; }
  bool cut_away = true;  ///< hide what lies before the image plane
  void clear_trail() { trail_.clear(); }

 private:
  JointView(const CompiledJoint& joint, GlProgram solid, GlProgram picture, double probe_width,
            double needle_length);
  struct Part {
    std::size_t look;
    Vec3 centre;
    GlMesh mesh;
  };
  void draw_parts(const Eigen::Matrix4f& view, const Eigen::Vector4f& plane);
  void draw_tools(const Eigen::Matrix4f& view, const HapticSnapshot& now);
  void draw_forces(const Eigen::Matrix4f& view, const HapticSnapshot& now);
  void draw_entry(const Eigen::Matrix4f& view, const EntryChoice& entry);
  void draw_image(const Eigen::Matrix4f& view, const ImageSnapshot& image,
                  const GlTexture& texture);
  void draw_trail(const Eigen::Matrix4f& view, const HapticSnapshot& now);
  void draw_mesh(const GlMesh& mesh, const Eigen::Matrix4f& view, const Eigen::Matrix4f& model,
                 const Eigen::Vector4f& colour, bool lit);

  GlProgram solid_;
  GlProgram picture_;
  GlTarget target_;
  std::vector<Part> parts_;
  std::vector<TissueLook> looks_;
  OrbitCamera camera_;
  Vec3 eye_ = Vec3::Zero();
  GlMesh box_;
  GlMesh rod_;
  GlMesh cone_;
  GlMesh quad_;
  GlMesh line_;
  std::deque<Eigen::Vector3f> trail_;
  double probe_width_;
  double needle_length_;
};

}  // namespace artus
