// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "artus/detail/soft/solver/deformed_body.h"
#include "artus/detail/viewer/joint3d/gl_objects.h"
#include "artus/detail/viewer/joint3d/surface_detail.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The body of an instant as far as its surfaces go: less than a scene, which others wait for.
struct BodyState {
  std::shared_ptr<const CompiledJoint> joint;  ///< with what was injected
  std::shared_ptr<const DeformedBody> tissue;  ///< how it gives way; null: rigid
};
[[nodiscard]] BodyState state_of(const Scene& scene);

/// Where the vertices of a joint's surfaces are in one body, and where they were compiled; frame J,
/// m. An empty `now`: at rest.
struct VertexPlaces {
  std::span<const Vec3> rest;  ///< a view of what the joint holds
  std::vector<Vec3> now;

  [[nodiscard]] Vec3 displacement(std::uint32_t vertex) const noexcept {
    return now.empty() ? Vec3::Zero() : Vec3(now[vertex] - rest[vertex]);
  }
};

/// The vertices of `joint` in a body of it: one that gives way, or one with liquid, whose own
/// vertices come after the joint's. Requires: a body of that joint. Cost: gathers them.
[[nodiscard]] VertexPlaces places_in(const CompiledJoint& joint, const BodyState& body);

/// Tells whether a body lies visibly otherwise than the one that was asked of last.
class BodySight {
 public:
  static constexpr double kVisible = 30e-6;  ///< m that a node of the cage moves; assumed

  /// True: it does, and is the last one from now on. Cost: linear in the cage's nodes.
  [[nodiscard]] bool changed(const BodyState& body);

 private:
  BodyState last_;
};

/// A surface on the graphics side that goes with a body: what moved since it was last moved is sent
/// again, and nothing else. Needs a current OpenGL context.
class MovingMesh {
 public:
  static constexpr float kStep = 10e-6F;  ///< m; what moved by less stays; assumed

  explicit MovingMesh(Surface surface);
  /// To where its points are in a body. Returns how many points were sent. Cost: linear.
  std::size_t move(const VertexPlaces& places);
  [[nodiscard]] const GlMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] std::span<const Eigen::Vector3f> points() const noexcept { return points_; }

 private:
  GlMesh mesh_;
  Surface rest_;
  std::vector<Eigen::Vector3f> points_;  // as sent
};

}  // namespace artus
