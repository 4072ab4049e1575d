// SPDX-License-Identifier: AGPL-3.0-or-later
// The sphere or plane along which the walls of a space are mapped.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

#include "artus/detail/soft/liquid/inflated_space.h"

namespace artus {
namespace {

constexpr double kFitRadius = 25e-3;   // m around the tip, of the walls that the sphere follows
constexpr double kHalfMap = 60e-3;     // m of the map of walls, to each side of the tip
constexpr double kWideCell = 1e-3;     // m, of that map
constexpr double kFinestCell = 25e-5;  // m
constexpr double kMapMargin = 2e-3;    // m of a fine map beside the space
constexpr double kFlat = 0.5;          // m, radius beyond which walls are flat

/// The nearest point of the body's skin, as far as vertices tell.
Vec3 nearest_skin(const CompiledJoint& joint, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 nearest = p + Vec3::UnitZ();
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kOutside && f.back != kOutside) continue;
    for (const std::uint32_t v : f.vertices) {
      const double d = (joint.mesh.vertices[v] - p).squaredNorm();
      if (d < least) {
        least = d;
        nearest = joint.mesh.vertices[v];
      }
    }
  }
  return nearest;
}

}  // namespace

/// |x|^2 = 2 c.x + d by least squares over the walls near the tip; empty where they are no sphere.
std::optional<Vec3> InflatedSpace::find_centre(const Vec3& tip) const {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const auto& triangle : triangles_) {
    for (const std::uint32_t v : triangle) {
      const Vec3 x = rest_[v] - tip;
      if (x.norm() > kFitRadius) continue;
      const Eigen::Vector4d row(2 * x.x(), 2 * x.y(), 2 * x.z(), 1);
      normal += row * row.transpose();
      right += row * x.squaredNorm();
    }
  }
  normal += 1e-9 * normal.trace() * Eigen::Matrix4d::Identity();
  const Vec3 to_centre = normal.ldlt().solve(right).head<3>();
  if (!to_centre.allFinite() || to_centre.norm() > kFlat || to_centre.norm() < 5e-3)
    return std::nullopt;
  return to_centre;
}

/// The direction in which the walls near the tip reach the least.
Vec3 InflatedSpace::find_normal(const Vec3& tip) const {
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double area = 0;
  for (const auto& [a, b, c] : triangles_) {
    const Vec3 x = (rest_[a] + rest_[b] + rest_[c]) / 3 - tip;
    if (x.norm() > kFitRadius) continue;
    const double part = (rest_[b] - rest_[a]).cross(rest_[c] - rest_[a]).norm() / 2;
    area += part;
    mean += part * x;
    spread += part * x * x.transpose();
  }
  if (!(area > 0)) return Vec3::Zero();
  spread -= mean * mean.transpose() / area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  return solver.eigenvectors().col(0);
}

/// m from the tip to the farthest of the walls.
double InflatedSpace::extent(const Vec3& tip) const {
  double squared = 0;
  for (const auto& triangle : triangles_)
    for (const std::uint32_t v : triangle)
      squared = std::max(squared, (rest_[v] - tip).squaredNorm());
  return std::sqrt(squared);
}

/// Maps the walls, more finely where the space has no place as wide as its opening's rim.
void InflatedSpace::set_frame(const CompiledJoint& joint, const Vec3& tip, const Frame& frame) {
  centre_ = tip + frame.to_centre;
  sphere_ = frame.to_centre.norm();
  sign_ = frame.to_centre.dot(frame.toward) < 0 ? 1 : -1;
  up_ = -frame.to_centre.normalized();
  side_ = up_.unitOrthogonal();
  double half = kHalfMap;
  cell_ = kWideCell;
  rim_ = params_.rim;
  cells_ = 2 * static_cast<int>(half / cell_ + 0.5) + 1;
  map_walls();
  while (!find_shut(joint) && cell_ > kFinestCell) {
    half = std::min(kHalfMap, extent(tip) + kMapMargin);
    cell_ /= 2;
    rim_ /= 2;
    cells_ = 2 * static_cast<int>(half / cell_ + 0.5) + 1;
    map_walls();
  }
}

/// The sphere of the walls, where half of a patch finds room along it; otherwise, of that, their
/// plane and the plane square to the direction out, the one along which there is the most; the
/// direction in, where none gives way outward.
void InflatedSpace::choose_frame(const CompiledJoint& joint, const Vec3& tip) {
  const Vec3 out = (nearest_skin(joint, tip) - tip).normalized();
  Vec3 normal = find_normal(tip);
  if (normal.dot(out) < 0) normal = -normal;
  std::vector<Frame> frames;
  if (const auto centre = find_centre(tip)) frames.push_back({*centre, out});
  if (normal.norm() > 0) frames.push_back({-kFlat * normal, out});
  frames.push_back({-kFlat * out, out});
  if (normal.norm() > 0) frames.push_back({kFlat * normal, -out});
  frames.push_back({kFlat * out, -out});
  const double enough = std::numbers::pi * params_.widest * params_.widest / 6;
  double most = 0;
  const Frame* best = nullptr;
  for (const Frame& frame : frames) {
    if (most > 0 && frame.toward != out) break;
    set_frame(joint, tip, frame);
    const double area = open_area(params_.widest, false);
    if (area >= enough) return;
    if (area <= most) continue;
    most = area;
    best = &frame;
  }
  if (best != nullptr) set_frame(joint, tip, *best);
}

}  // namespace artus
