// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/joint3d/body_shape.h"

#include <algorithm>
#include <utility>

namespace artus {

BodyState state_of(const Scene& scene) {
  return {scene.shared_joint(), scene.tissue()};
}

VertexPlaces places_in(const CompiledJoint& joint, const BodyState& body) {
  const std::vector<Vec3>& rest = joint.mesh.vertices;
  if (body.tissue) return {rest, body.tissue->vertices()};
  if (body.joint.get() == &joint) return {rest, {}};
  return {rest, body.joint->mesh.vertices};
}

bool BodySight::changed(const BodyState& body) {
  const auto same_place = [](const Vec3& a, const Vec3& b) {
    return (a - b).squaredNorm() < kVisible * kVisible;
  };
  const auto same_tissue = [&](const DeformedBody& a, const DeformedBody& b) {
    const auto u = a.node_displacements();
    const auto v = b.node_displacements();
    return a.shared_map() == b.shared_map() &&
           std::equal(u.begin(), u.end(), v.begin(), v.end(), same_place);
  };
  const bool same = body.joint == last_.joint &&
                    (body.tissue == last_.tissue ||
                     (body.tissue && last_.tissue && same_tissue(*body.tissue, *last_.tissue)));
  if (!same) last_ = body;
  return !same;
}

MovingMesh::MovingMesh(Surface surface) : rest_(std::move(surface)), points_(rest_.points) {
  mesh_.set_points(points_);
  mesh_.set_triangles(rest_.indices);
}

std::size_t MovingMesh::move(const VertexPlaces& places) {
  std::size_t first = points_.size();
  std::size_t end = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3f now =
        rest_.points[i] + places.displacement(rest_.sources[i]).cast<float>();
    if ((now - points_[i]).squaredNorm() < kStep * kStep) continue;
    points_[i] = now;
    first = std::min(first, i);
    end = i + 1;
  }
  if (end == 0) return 0;
  const std::span<const Eigen::Vector3f> sent = std::span(points_).subspan(first, end - first);
  mesh_.move_points(first, sent);
  return sent.size();
}

}  // namespace artus
