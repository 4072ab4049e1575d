// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/inflated_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "artus/core/check.h"

namespace artus {
namespace {

constexpr int kCells = 121;           // of the map of walls, along each side
constexpr double kCell = 1e-3;        // m
constexpr double kFitRadius = 25e-3;  // m around the tip, of the walls that the sphere follows
constexpr double kFlat = 0.5;         // m, radius beyond which walls are flat
constexpr double kWidest = kCells * kCell / 2;
constexpr int kSteps = 60;
constexpr int kHalvings = 20;
constexpr double kExact = 1e-16;  // m^3

double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c));
}

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

InflatedSpace::InflatedSpace(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                             const OpeningParams& params)
    : params_(params), rest_(joint.mesh.vertices) {
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front == region) triangles_.push_back({f.vertices[0], f.vertices[2], f.vertices[1]});
    if (f.back == region) triangles_.push_back(f.vertices);
  }
  ARTUS_REQUIRE(!triangles_.empty(), "the region must have interfaces");
  fit_sphere(joint, tip);
  rest_volume_ = volume_of(rest_);
  map_walls();
  find_shut(joint);
  find_lifts();
  leave_floor(joint, region);
}

/// |x|^2 = 2 c.x + d by least squares over the walls near the tip.
void InflatedSpace::fit_sphere(const CompiledJoint& joint, const Vec3& tip) {
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
  const Eigen::Vector4d found = normal.ldlt().solve(right);
  const Vec3 skin = nearest_skin(joint, tip);
  Vec3 to_centre = found.head<3>();
  const Vec3 out = (skin - tip).normalized();
  if (!to_centre.allFinite() || to_centre.norm() > kFlat || to_centre.norm() < 5e-3)
    to_centre = -kFlat * out;
  centre_ = tip + to_centre;
  sphere_ = to_centre.norm();
  sign_ = to_centre.dot(out) < 0 ? 1 : -1;
  up_ = -to_centre.normalized();
  side_ = up_.unitOrthogonal();
}

/// (u, v, height): m along the sphere from the tip's direction, and above it toward the roof.
Vec3 InflatedSpace::polar(const Vec3& p) const {
  const Vec3 x = p - centre_;
  const double distance = std::max(x.norm(), 1e-9);
  const double along = x.dot(up_);
  const Vec3 across = x - along * up_;
  const double r = sphere_ * std::atan2(across.norm(), along);
  const double size = std::max(across.norm(), 1e-12);
  return {r * across.dot(side_) / size, r * across.dot(up_.cross(side_)) / size,
          sign_ * (distance - sphere_)};
}

std::size_t InflatedSpace::cell(double u, double v) const {
  const auto at = [](double x) {
    return std::clamp(static_cast<int>(std::floor(x / kCell)) + kCells / 2, 0, kCells - 1);
  };
  return static_cast<std::size_t>(at(v) * kCells + at(u));
}

void InflatedSpace::map_walls() {
  const auto n = static_cast<std::size_t>(kCells * kCells);
  low_.assign(n, std::numeric_limits<double>::infinity());
  top_.assign(n, -std::numeric_limits<double>::infinity());
  for (const auto& [ia, ib, ic] : triangles_) {
    const Vec3 a = polar(rest_[ia]);
    const Vec3 ab = polar(rest_[ib]) - a;
    const Vec3 ac = polar(rest_[ic]) - a;
    const int steps =
        1 + static_cast<int>(2 * std::max({ab.norm(), ac.norm(), (ab - ac).norm()}) / kCell);
    if (steps > 4 * kCells) continue;  // round the far side of the sphere
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const Vec3 p = a + ab * i / steps + ac * j / steps;
        const std::size_t c = cell(p.x(), p.y());
        low_[c] = std::min(low_[c], p.z());
        top_[c] = std::max(top_[c], p.z());
      }
    }
  }
}

/// Where the space may open: away from its own rim and from bone that lies on it, which does not
/// give way.
void InflatedSpace::find_shut(const CompiledJoint& joint) {
  std::vector<bool> shut(top_.size());
  for (std::size_t c = 0; c < top_.size(); ++c) shut[c] = top_[c] < low_[c];
  for (const Interface& f : joint.mesh.interfaces) {
    if (!joint.tissue_of(f.front).haptic.hard && !joint.tissue_of(f.back).haptic.hard) continue;
    for (const std::uint32_t v : f.vertices) {
      const Vec3 p = polar(rest_[v]);
      const std::size_t here = cell(p.x(), p.y());
      const double roof = top_[here] >= low_[here] ? top_[here] : 0;
      if (p.z() < roof) continue;
      const double together = 1 / (1 + (p.z() - roof) / params_.spread);
      shut[cell(together * p.x(), together * p.y())] = true;
    }
  }
  inside_.assign(top_.size(), 0);
  const int reach = static_cast<int>(std::ceil(params_.rim / kCell));
  for (int v = 0; v < kCells; ++v) {
    for (int u = 0; u < kCells; ++u) {
      double nearest = params_.rim;
      for (int dv = -reach; dv <= reach; ++dv) {
        for (int du = -reach; du <= reach; ++du) {
          const int x = u + du;
          const int y = v + dv;
          const bool off = x < 0 || y < 0 || x >= kCells || y >= kCells;
          if (off || shut[static_cast<std::size_t>(y * kCells + x)])
            nearest = std::min(nearest, kCell * std::hypot(du, dv));
        }
      }
      inside_[static_cast<std::size_t>(v * kCells + u)] = nearest / params_.rim;
    }
  }
}

/// Between cells, so that the roof has no steps.
double InflatedSpace::wall_mask(double u, double v) const {
  const double x = u / kCell - 0.5;
  const double y = v / kCell - 0.5;
  const double fx = x - std::floor(x);
  const double fy = y - std::floor(y);
  const auto at = [&](double dx, double dy) {
    return inside_[cell((std::floor(x) + dx + 0.5) * kCell, (std::floor(y) + dy + 0.5) * kCell)];
  };
  return (1 - fy) * ((1 - fx) * at(0, 0) + fx * at(1, 0)) +
         fy * ((1 - fx) * at(0, 1) + fx * at(1, 1));
}

/// Of each vertex, how much the walls that it belongs to look upward; 0 where it is of none.
std::vector<double> InflatedSpace::facing() const {
  std::vector<double> facing(rest_.size(), 0);
  for (const auto& triangle : triangles_) {
    const Vec3& a = rest_[triangle[0]];
    const Vec3 normal = (rest_[triangle[1]] - a).cross(rest_[triangle[2]] - a);
    for (const std::uint32_t v : triangle) facing[v] += sign_ * normal.dot(rest_[v] - centre_);
  }
  return facing;
}

void InflatedSpace::find_lifts() {
  const std::vector<double> walls = facing();
  for (std::uint32_t i = 0; i < rest_.size(); ++i) {
    const Vec3 p = polar(rest_[i]);
    const std::size_t here = cell(p.x(), p.y());
    // Where the space is not below a point itself, its neighbours tell at which height it would be.
    const bool known = top_[here] >= low_[here];
    const double middle = known ? (low_[here] + top_[here]) / 2 : 0;
    if (walls[i] != 0 ? walls[i] < 0 : !(p.z() > middle)) continue;
    const double above = std::max(0.0, p.z() - (known ? top_[here] : 0));
    const double together = 1 / (1 + above / params_.spread);
    const double u = together * p.x();
    const double v = together * p.y();
    const double share = together * together * wall_mask(u, v);
    const double r = std::hypot(u, v);
    if (!(share > 0) || r >= kWidest) continue;
    lifts_.push_back({i, sign_ * (rest_[i] - centre_).normalized(), r, share});
  }
}

/// A structure that lies below nearly everywhere, a tendon or the bone, is not torn by the few of
/// its vertices that a wrinkled floor puts above: none of them is lifted.
void InflatedSpace::leave_floor(const CompiledJoint& joint, RegionId region) {
  constexpr double kFloor = 0.8;  // of its vertices; assumed
  struct Votes {
    double lifted = 0;
    double all = 0;
  };
  std::vector<bool> lifted(rest_.size(), false);
  for (const Lift& lift : lifts_) lifted[lift.vertex] = true;
  std::vector<Votes> votes(joint.regions.size());
  const auto visit = [&](auto&& take) {
    for (const Interface& f : joint.mesh.interfaces)
      for (const RegionId side : {f.front, f.back})
        if (side >= kFirstRegion && side != region)
          for (const std::uint32_t v : f.vertices) take(side, v);
  };
  visit([&](RegionId side, std::uint32_t v) {
    const Vec3 p = polar(rest_[v]);
    if (top_[cell(p.x(), p.y())] < low_[cell(p.x(), p.y())]) return;
    votes[side].all += 1;
    if (lifted[v]) votes[side].lifted += 1;
  });
  visit([&](RegionId side, std::uint32_t v) {
    if (votes[side].lifted < (1 - kFloor) * votes[side].all) lifted[v] = false;
  });
  lifts_.erase(std::remove_if(lifts_.begin(), lifts_.end(),
                              [&](const Lift& lift) { return !lifted[lift.vertex]; }),
               lifts_.end());
}

/// m^2 of (1 - (r/a)^2) over the map, of all of it or where the space may open.
double InflatedSpace::open_area(double radius, bool everywhere) const {
  double sum = 0;
  for (int v = 0; v < kCells; ++v) {
    for (int u = 0; u < kCells; ++u) {
      const double q = kCell * std::hypot(u - kCells / 2, v - kCells / 2) / radius;
      const double inside = inside_[static_cast<std::size_t>(v * kCells + u)];
      if (q < 1) sum += (1 - q * q) * (everywhere ? 1 : inside);
    }
  }
  return sum * kCell * kCell;
}

double InflatedSpace::radius(double volume) const {
  double low = params_.widest * std::cbrt(std::min(1.0, volume / params_.fill));
  const double wanted = open_area(low, true);
  if (open_area(low, false) >= wanted) return low;
  double high = kWidest;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (low + high) / 2;
    (open_area(middle, false) < wanted ? low : high) = middle;
  }
  return high;
}

std::vector<Vec3> InflatedSpace::lifted(double height, double radius) const {
  std::vector<Vec3> vertices = rest_;
  for (const Lift& lift : lifts_) {
    const double q = lift.r / radius;
    if (q < 1) vertices[lift.vertex] += height * lift.share * (1 - q * q) * lift.direction;
  }
  return vertices;
}

double InflatedSpace::volume_of(const std::vector<Vec3>& vertices) const {
  double sum = 0;
  for (const auto& [a, b, c] : triangles_)
    sum += six_volumes(vertices[a] - centre_, vertices[b] - centre_, vertices[c] - centre_);
  return sum / 6;
}

double InflatedSpace::height_for(double volume) const {
  if (!(volume > 0)) return 0;
  const double a = radius(volume);
  double low = 0;
  double at_low = -volume;
  double high = volume / (a * a);
  double at_high = volume_of(lifted(high, a)) - rest_volume_ - volume;
  for (int k = 0; k < kSteps && std::abs(at_high) > kExact; ++k) {
    if (at_high == at_low) break;
    const double next = high - at_high * (high - low) / (at_high - at_low);
    low = high;
    at_low = at_high;
    high = next;
    at_high = volume_of(lifted(high, a)) - rest_volume_ - volume;
  }
  return high;
}

std::vector<Vec3> InflatedSpace::vertices(double volume) const {
  ARTUS_REQUIRE(volume >= 0, "a volume of at least 0");
  return lifted(height_for(volume), radius(std::max(volume, 1e-12)));
}

double InflatedSpace::largest_opening(double volume) const {
  const double height = height_for(volume);
  const double a = radius(std::max(volume, 1e-12));
  double largest = 0;
  for (const Lift& lift : lifts_) {
    const double q = lift.r / a;
    if (q < 1) largest = std::max(largest, height * lift.share * (1 - q * q));
  }
  return largest;
}

}  // namespace artus
