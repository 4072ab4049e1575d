// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/inflated_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr double kNextCell = 1.5;        // cells, to beyond any one beside
constexpr double kStart = 5e-3;          // m around the tip, where the space may be met first
constexpr double kAllOpen = 121e-3 / 2;  // m, radius of a patch that is all of a space
constexpr int kSteps = 60;
constexpr int kHalvings = 20;
constexpr double kExactVolume = 1e-16;  // m^3
constexpr double kEdge = 1e-9;          // of a triangle's side

constexpr double kRound = 0.9 * std::numbers::pi;  // of the sphere that the map covers
constexpr double kThinnest = 0.1e-3;               // m between a floor and a roof
// The part of the way from floor to roof that is drawn out; walls rougher than the rest follow.
constexpr double kFixed = 0.25;

/// Of a plate held at its rim, of radius 1.
double profile(double q) {
  return q < 1 ? (1 - q * q) * (1 - q * q) : 0;
}

/// Where the line from `origin` along `d` meets the triangle, and whether it leaves by it.
std::optional<std::pair<double, bool>> meet(const Vec3& origin, const Vec3& d, const Vec3& a,
                                            const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 p = d.cross(ac);
  const double det = ab.dot(p);
  if (det == 0) return std::nullopt;
  const Vec3 from = origin - a;
  const double u = from.dot(p) / det;
  const Vec3 q = from.cross(ab);
  const double v = d.dot(q) / det;
  // A line along an edge meets both triangles rather than none.
  if (u < -kEdge || v < -kEdge || u + v > 1 + kEdge) return std::nullopt;
  return std::pair{ac.dot(q) / det, ab.cross(ac).dot(d) > 0};
}

double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c));
}

}  // namespace

InflatedSpace::InflatedSpace(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                             const OpeningParams& params)
    : params_(params), rest_(joint.mesh.vertices) {
  bone_.assign(rest_.size(), false);
  for (const Interface& f : joint.mesh.interfaces) {
    if (joint.tissue_of(f.front).haptic.hard || joint.tissue_of(f.back).haptic.hard)
      for (const std::uint32_t v : f.vertices) bone_[v] = true;
    if (f.front == region) triangles_.push_back({f.vertices[0], f.vertices[2], f.vertices[1]});
    if (f.back == region) triangles_.push_back(f.vertices);
  }
  ARTUS_REQUIRE(!triangles_.empty(), "the region must have interfaces");
  choose_frame(joint, tip);
  rest_volume_ = volume_of(rest_);
  find_lifts();
}

/// Of cell i, the place of its middle on the map.
double InflatedSpace::middle(int i) const {
  return cell_ * (i - cells_ / 2 + 0.5);
}

int InflatedSpace::cell_of(double x) const {
  return static_cast<int>(std::floor(x / cell_)) + cells_ / 2;
}

std::size_t InflatedSpace::at(int u, int v) const {
  return static_cast<std::size_t>(std::clamp(v, 0, cells_ - 1) * cells_ +
                                  std::clamp(u, 0, cells_ - 1));
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

/// The point of which polar() is (u, v, height).
Vec3 InflatedSpace::place_of(double u, double v, double height) const {
  const double r = std::hypot(u, v);
  const Vec3 across = r > 0 ? Vec3((u * side_ + v * up_.cross(side_)) / r) : side_;
  const Vec3 d = std::cos(r / sphere_) * up_ + std::sin(r / sphere_) * across;
  return centre_ + (sphere_ + sign_ * height) * d;
}

/// By cell, where a line along the height is inside the space, from below.
std::vector<std::vector<InflatedSpace::Span>> InflatedSpace::find_spans() const {
  struct Hit {
    double height;
    bool leaves;
  };
  std::vector<std::vector<Hit>> hits(floor_.size());
  for (const auto& [ia, ib, ic] : triangles_) {
    const Vec3 a = polar(rest_[ia]);
    const Vec3 b = polar(rest_[ib]);
    const Vec3 c = polar(rest_[ic]);
    const Vec3 low = a.cwiseMin(b).cwiseMin(c);
    const Vec3 high = a.cwiseMax(b).cwiseMax(c);
    if ((high - low).head<2>().norm() > sphere_) continue;  // round the far side
    for (int v = std::max(cell_of(low.y()) - 1, 0); v <= cell_of(high.y()) + 1 && v < cells_; ++v) {
      for (int u = std::max(cell_of(low.x()) - 1, 0); u <= cell_of(high.x()) + 1 && u < cells_;
           ++u) {
        const double r = std::hypot(middle(u), middle(v));
        if (r > kRound * sphere_) continue;
        const Vec3 across = (middle(u) * side_ + middle(v) * up_.cross(side_)).normalized();
        const Vec3 d = std::cos(r / sphere_) * up_ + std::sin(r / sphere_) * across;
        const auto met = meet(centre_, d, rest_[ia], rest_[ib], rest_[ic]);
        if (met && met->first > 0)
          hits[at(u, v)].push_back({sign_ * (met->first - sphere_), met->second == (sign_ > 0)});
      }
    }
  }
  std::vector<std::vector<Span>> spans(hits.size());
  for (std::size_t k = 0; k < hits.size(); ++k) {
    std::sort(hits[k].begin(), hits[k].end(),
              [](const Hit& x, const Hit& y) { return x.height < y.height; });
    for (std::size_t i = 0; i + 1 < hits[k].size(); ++i)
      if (!hits[k][i].leaves && hits[k][i + 1].leaves)
        spans[k].push_back({hits[k][i].height, hits[k][i + 1].height});
  }
  return spans;
}

/// From the tip outward, of each cell the part of the space that goes on from its neighbour's.
void InflatedSpace::map_walls() {
  const auto n = static_cast<std::size_t>(cells_ * cells_);
  open_.assign(n, false);
  floor_.assign(n, 0);
  roof_.assign(n, 0);
  const auto spans = find_spans();
  std::vector<std::pair<int, int>> reached;
  const auto gap = [](const Span& x, const Span& y) {
    return std::max(x[0], y[0]) - std::min(x[1], y[1]);
  };
  const auto take = [&](int u, int v, const Span& from, double farthest) {
    const std::size_t c = at(u, v);
    if (open_[c] || spans[c].empty()) return;
    const Span& best = *std::min_element(
        spans[c].begin(), spans[c].end(),
        [&](const Span& x, const Span& y) { return gap(x, from) < gap(y, from); });
    if (gap(best, from) > farthest) return;
    open_[c] = true;
    floor_[c] = best[0];
    roof_[c] = best[1];
    reached.emplace_back(u, v);
  };
  const int start = static_cast<int>(std::lround(kStart / cell_));
  for (int k = 0; k <= start && reached.empty(); ++k)
    for (int dv = -k; dv <= k && reached.empty(); ++dv)
      for (int du = -k; du <= k && reached.empty(); ++du)
        take(cells_ / 2 + du, cells_ / 2 + dv, {0, 0}, widest());
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const auto [u, v] = reached[k];
    const Span here{floor_[at(u, v)], roof_[at(u, v)]};
    for (const auto& [du, dv] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      if (u + du >= 0 && u + du < cells_ && v + dv >= 0 && v + dv < cells_)
        take(u + du, v + dv, here, cell_);
  }
  smooth_walls();
}

/// Goes on with the walls beside the sheet and takes the roughness of single cells from them.
void InflatedSpace::smooth_walls() {
  std::vector<bool> known = open_;
  const auto pass = [&](bool all) {
    bool more = false;
    const std::vector<double> floor = floor_;
    const std::vector<double> roof = roof_;
    const std::vector<bool> before = known;
    for (int v = 0; v < cells_; ++v) {
      for (int u = 0; u < cells_; ++u) {
        if (!all && before[at(u, v)]) continue;
        double n = 0;
        double low = 0;
        double high = 0;
        for (int dv = -1; dv <= 1; ++dv) {
          for (int du = -1; du <= 1; ++du) {
            const std::size_t c = at(u + du, v + dv);
            if (!before[c]) continue;
            n += 1;
            low += floor[c];
            high += roof[c];
          }
        }
        if (n == 0) continue;
        more = more || !before[at(u, v)];
        known[at(u, v)] = true;
        floor_[at(u, v)] = low / n;
        roof_[at(u, v)] = high / n;
      }
    }
    return more;
  };
  while (pass(false)) {
  }
  pass(true);
  for (std::size_t c = 0; c < roof_.size(); ++c)
    roof_[c] = std::max(roof_[c], floor_[c] + kThinnest);
}

/// Where bone lies on the space, or in the upper half of it, by cell: it does not give way.
std::vector<bool> InflatedSpace::find_bone(const CompiledJoint& joint) const {
  std::vector<bool> bone(open_.size(), false);
  const auto mark = [&](const Vec3& point) {
    const Vec3 p = polar(point);
    const double roof = between(roof_, p.x(), p.y());
    const double thick = roof - between(floor_, p.x(), p.y());
    if (p.z() < roof - std::min(thick / 2, cell_)) return;
    const double together = 1 / (1 + std::max(0.0, p.z() - roof) / params_.spread);
    bone[at(cell_of(together * p.x()), cell_of(together * p.y()))] = true;
  };
  for (const Interface& f : joint.mesh.interfaces) {
    if (!joint.tissue_of(f.front).haptic.hard && !joint.tissue_of(f.back).haptic.hard) continue;
    const Vec3& a = rest_[f.vertices[0]];
    const Vec3 ab = rest_[f.vertices[1]] - a;
    const Vec3 ac = rest_[f.vertices[2]] - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int n = std::clamp(static_cast<int>(std::ceil(longest / cell_)), 1, cells_);
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) mark(a + (ab * i + ac * j) / n);
  }
  return bone;
}

/// Where the space may open: away from its own rim and from bone that lies on it. False where no
/// place is as far from them as its opening's rim is wide.
bool InflatedSpace::find_shut(const CompiledJoint& joint) {
  std::vector<bool> shut = find_bone(joint);
  for (std::size_t c = 0; c < shut.size(); ++c) shut[c] = shut[c] || !open_[c];
  inside_.assign(shut.size(), 0);
  const double next = kNextCell * cell_;
  const double farthest = rim_ + next;
  const int reach = static_cast<int>(std::ceil(farthest / cell_));
  bool wide = false;
  for (int v = 0; v < cells_; ++v) {
    for (int u = 0; u < cells_; ++u) {
      double nearest = farthest;
      for (int dv = -reach; dv <= reach; ++dv) {
        for (int du = -reach; du <= reach; ++du) {
          const int x = u + du;
          const int y = v + dv;
          const bool off = x < 0 || y < 0 || x >= cells_ || y >= cells_;
          if (off || shut[at(x, y)]) nearest = std::min(nearest, cell_ * std::hypot(du, dv));
        }
      }
      wide = wide || nearest >= farthest;
      const double part = std::max(0.0, nearest - next) / rim_;
      inside_[at(u, v)] = part * part * (3 - 2 * part);
    }
  }
  return wide;
}

/// Of a map by cells, between their middles, so that nothing has steps.
double InflatedSpace::between(const std::vector<double>& map, double u, double v) const {
  const double x = u / cell_ + cells_ / 2 - 0.5;
  const double y = v / cell_ + cells_ / 2 - 0.5;
  const double fx = x - std::floor(x);
  const double fy = y - std::floor(y);
  const int i = static_cast<int>(std::floor(x));
  const int j = static_cast<int>(std::floor(y));
  return (1 - fy) * ((1 - fx) * map[at(i, j)] + fx * map[at(i + 1, j)]) +
         fy * ((1 - fx) * map[at(i, j + 1)] + fx * map[at(i + 1, j + 1)]);
}

/// Along each line of height the lift never falls faster than one comes up, so what is above stays
/// above.
void InflatedSpace::find_lifts() {
  for (std::uint32_t i = 0; i < rest_.size(); ++i) {
    const Vec3 p = polar(rest_[i]);
    if (std::hypot(p.x(), p.y()) > kRound * sphere_) continue;
    const double floor = between(floor_, p.x(), p.y());
    const double roof = between(roof_, p.x(), p.y());
    const double part = (p.z() - floor) / (roof - floor);
    const double drawn = std::clamp((part - kFixed) / (1 - 2 * kFixed), 0.0, 1.0);
    const double together = 1 / (1 + std::max(0.0, p.z() - roof) / params_.spread);
    const double u = together * p.x();
    const double v = together * p.y();
    const double share = drawn * together * together * between(inside_, u, v);
    const double r = std::hypot(u, v);
    if (!(share > 0) || r >= widest() || bone_[i]) continue;
    lifts_.push_back({i, sign_ * (rest_[i] - centre_).normalized(), r, share, u, v});
  }
}

/// m^2 of the plate over the map, of all of it or where the space may open.
double InflatedSpace::open_area(double radius, bool everywhere) const {
  double sum = 0;
  for (int v = 0; v < cells_; ++v) {
    for (int u = 0; u < cells_; ++u) {
      const double q = std::hypot(middle(u), middle(v)) / radius;
      sum += profile(q) * (everywhere ? 1 : inside_[at(u, v)]);
    }
  }
  return sum * cell_ * cell_;
}

double InflatedSpace::radius(double volume) const {
  double low = params_.widest * std::cbrt(std::min(1.0, volume / params_.fill));
  const double wanted = open_area(low, true);
  if (open_area(low, false) >= wanted) return low;
  double high = kAllOpen;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (low + high) / 2;
    (open_area(middle, false) < wanted ? low : high) = middle;
  }
  return high;
}

std::vector<double> InflatedSpace::heights(double height, double radius) const {
  std::vector<double> all;
  all.reserve(lifts_.size());
  for (const Lift& lift : lifts_) all.push_back(height * lift.share * profile(lift.r / radius));
  return all;
}

std::vector<Vec3> InflatedSpace::lifted(const std::vector<double>& heights) const {
  std::vector<Vec3> vertices = rest_;
  for (std::size_t k = 0; k < lifts_.size(); ++k)
    vertices[lifts_[k].vertex] += heights[k] * lifts_[k].direction;
  return vertices;
}

double InflatedSpace::volume_of(const std::vector<Vec3>& vertices) const {
  double sum = 0;
  for (const auto& [a, b, c] : triangles_)
    sum += six_volumes(vertices[a] - centre_, vertices[b] - centre_, vertices[c] - centre_);
  return sum / 6;
}

double InflatedSpace::opened_by(const std::vector<double>& heights) const {
  return volume_of(lifted(heights)) - rest_volume_;
}

double InflatedSpace::height_for(double volume) const {
  if (!(volume > 0)) return 0;
  const double a = radius(volume);
  double low = 0;
  double at_low = -volume;
  double high = volume / (a * a);
  double at_high = opened_by(heights(high, a)) - volume;
  for (int k = 0; k < kSteps && std::abs(at_high) > kExactVolume; ++k) {
    if (at_high == at_low) break;
    const double next = high - at_high * (high - low) / (at_high - at_low);
    low = high;
    at_low = at_high;
    high = next;
    at_high = opened_by(heights(high, a)) - volume;
  }
  return high;
}

bool InflatedSpace::confines(double volume) const {
  return radius(std::max(volume, 1e-12)) > 0.99 * kAllOpen;
}

/// `rested` by max(0, lambda - press): the volume is convex in lambda, so that secants which begin
/// where it is too much come down to the one that is kept and never pass it.
std::vector<double> InflatedSpace::squeezed(double volume, const std::vector<double>& rested,
                                            const Press& press) const {
  std::vector<double> map(floor_.size());  // of what presses, by cell
  for (int v = 0; v < cells_; ++v) {
    for (int u = 0; u < cells_; ++u) {
      const std::size_t c = at(u, v);
      map[c] = std::max(0.0, press(place_of(middle(u), middle(v), (floor_[c] + roof_[c]) / 2)));
    }
  }
  std::vector<double> on;
  on.reserve(lifts_.size());
  for (const Lift& lift : lifts_) on.push_back(between(map, lift.u, lift.v));
  const auto under = [&](double lambda) {
    std::vector<double> all = rested;
    for (std::size_t k = 0; k < all.size(); ++k) all[k] *= std::max(0.0, lambda - on[k]);
    return all;
  };
  double high = 2 + *std::max_element(map.begin(), map.end());
  double at_high = opened_by(under(high)) - volume;
  double lambda = high - 1;
  double now = opened_by(under(lambda)) - volume;
  for (int k = 0; k < kSteps && std::abs(now) > kExactVolume && at_high != now; ++k) {
    const double next = lambda - now * (high - lambda) / (at_high - now);
    high = lambda;
    at_high = now;
    lambda = next;
    now = opened_by(under(lambda)) - volume;
  }
  return under(lambda);
}

std::vector<Vec3> InflatedSpace::vertices(double volume, const Press& press) const {
  ARTUS_REQUIRE(volume >= 0, "a volume of at least 0");
  const std::vector<double> rested = heights(height_for(volume), radius(std::max(volume, 1e-12)));
  return lifted(press && volume > 0 ? squeezed(volume, rested, press) : rested);
}

double InflatedSpace::largest_opening(double volume) const {
  const double height = height_for(volume);
  const double a = radius(std::max(volume, 1e-12));
  double largest = 0;
  for (const Lift& lift : lifts_) {
    largest = std::max(largest, height * lift.share * profile(lift.r / a));
  }
  return largest;
}

}  // namespace artus
