// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/edge_lines.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

namespace artus::kit {
namespace {

using Point = Eigen::Vector2d;

/// A line by one of its points and its unit normal.
struct Line {
  Point at = Point::Zero();
  Point normal = Point::UnitX();
};

double linear(unsigned char value) {
  constexpr double kGamma = 2.2;
  return std::pow(value / 255.0, kGamma);
}

/// 0 to 255 as light.
std::array<double, 256> make_light_table() {
  std::array<double, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = linear(static_cast<unsigned char>(i));
  return table;
}

/// Light in a place of the picture, between pixels by proportion; outside of it the nearest's.
class Light {
 public:
  explicit Light(const cv::Mat& grey) : grey_(grey), table_(make_light_table()) {}
  [[nodiscard]] double at(const Point& p) const {
    const double x = std::clamp(p.x(), 0.0, grey_.cols - 1.001);
    const double y = std::clamp(p.y(), 0.0, grey_.rows - 1.001);
    const int i = static_cast<int>(x);
    const int j = static_cast<int>(y);
    const double u = x - i;
    const double v = y - j;
    const auto* row = grey_.ptr<unsigned char>(j);
    const auto* next = grey_.ptr<unsigned char>(j + 1);
    return (1 - v) * ((1 - u) * table_[row[i]] + u * table_[row[i + 1]]) +
           v * ((1 - u) * table_[next[i]] + u * table_[next[i + 1]]);
  }

 private:
  const cv::Mat& grey_;
  std::array<double, 256> table_;
};

/// Where the light rises most along `normal` (out of the black border into the white around it),
/// and how much it rises.
struct Rise {
  double offset = 0;
  double height = 0;
};
Rise find_rise(const Light& light, const Point& at, const Point& normal, double reach) {
  constexpr double kStep = 0.5;  // pixels
  const int n = static_cast<int>(std::round(reach / kStep));
  double sum = 0;
  double weighted = 0;
  double before = light.at(at - n * kStep * normal);
  for (int k = -n + 1; k <= n; ++k) {
    const double now = light.at(at + k * kStep * normal);
    const double rise = std::max(now - before, 0.0);
    sum += rise;
    weighted += rise * (k - 0.5) * kStep;
    before = now;
  }
  return {sum > 0 ? weighted / sum : 0, sum};
}

/// How far along `normal` the steepest rise over two pixels is, within `search` pixels.
double steepest(const Light& light, const Point& at, const Point& normal, double search) {
  constexpr double kStep = 0.5;  // pixels
  double best = 0;
  double place = 0;
  const int n = static_cast<int>(std::round(search / kStep));
  for (int k = -n; k <= n; ++k) {
    const double s = k * kStep;
    const double rise = light.at(at + (s + 1) * normal) - light.at(at + (s - 1) * normal);
    if (rise <= best) continue;
    best = rise;
    place = s;
  }
  return place;
}

/// Places on an edge, each with its weight.
struct Places {
  std::vector<Point> points;
  std::vector<double> weights;
  void keep(std::size_t from, std::size_t to) {
    points[to] = points[from];
    weights[to] = weights[from];
  }
  void shrink(std::size_t n) {
    points.resize(n);
    weights.resize(n);
  }
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The line through places by their weights.
Line line_through(const Places& places) {
  Point mean = Point::Zero();
  double total = 0;
  for (std::size_t i = 0; i < places.points.size(); ++i) {
    mean += places.weights[i] * places.points[i];
    total += places.weights[i];
  }
  mean /= total;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < places.points.size(); ++i)
    spread += places.weights[i] * (places.points[i] - mean) * (places.points[i] - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(spread);
  return Line{mean, solver.eigenvectors().col(0)};
}

/// Leaves out where the light rises otherwise than elsewhere: a finger, a neighbour.
void drop_other_rises(Places& places) {
  constexpr double kLess = 0.6;
  constexpr double kMore = 1.6;
  const double usual = median_of(places.weights);
  std::size_t n = 0;
  for (std::size_t i = 0; i < places.points.size(); ++i)
    if (places.weights[i] > kLess * usual && places.weights[i] < kMore * usual) places.keep(i, n++);
  places.shrink(n);
}

/// Leaves out what is off the line; returns how far the rest is off, rms in pixels.
double drop_far(Places& places, const Line& line) {
  constexpr double kAlways = 0.3;      // pixels
  constexpr double kDeviations = 3.7;  // of the median distance: 2.5 standard deviations
  std::vector<double> off;
  for (const Point& p : places.points) off.push_back(std::abs(line.normal.dot(p - line.at)));
  const double most = std::max(kAlways, kDeviations * median_of(off));
  std::size_t n = 0;
  double sum = 0;
  for (std::size_t i = 0; i < places.points.size(); ++i) {
    if (off[i] > most) continue;
    sum += off[i] * off[i];
    places.keep(i, n++);
  }
  places.shrink(n);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(n, 1)));
}

/// The edge from `a` to `b` with the marker to its right (corners run clockwise on the picture);
/// `reach`: pixels to both sides that are its own.
std::optional<Line> find_edge(const Light& light, const Point& a, const Point& b, double reach) {
  constexpr double kOffCorner = 0.12;  // share of the edge at both ends that is left alone
  constexpr double kLeast = 0.02;      // of the light's range that an edge rises
  constexpr double kStraight = 0.35;   // pixels off the line, rms
  constexpr double kStep = 0.7;        // pixels along the edge
  constexpr double kSearch = 2.5;      // pixels that the search may have been off
  constexpr double kSeen = 0.65;       // share of the edge that must be seen
  const double length = (b - a).norm();
  if (length < 8) return std::nullopt;
  Line line{(a + b) / 2, Point((b - a).y(), -(b - a).x()) / length};
  double off = 0;
  for (int pass = 0; pass < 4; ++pass) {
    Point along(-line.normal.y(), line.normal.x());
    if (along.dot(b - a) < 0) along = -along;
    const Point out(along.y(), -along.x());
    const double from = (a - line.at).dot(along) + kOffCorner * length;
    const double to = (b - line.at).dot(along) - kOffCorner * length;
    Places places;
    double all = 0;
    for (double s = from; s <= to; s += kStep) {
      Point at = line.at + s * along;
      if (pass < 2) at += steepest(light, at, out, pass == 0 ? kSearch : 1) * out;
      const Rise rise = find_rise(light, at, out, reach);
      all += 1;
      if (rise.height < kLeast) continue;
      places.points.push_back(at + rise.offset * out);
      places.weights.push_back(rise.height);
    }
    const auto seen = [&] {
      return static_cast<double>(places.points.size()) >= std::max(kSeen * all, 6.0);
    };
    if (!seen()) return std::nullopt;
    drop_other_rises(places);
    if (!seen()) return std::nullopt;
    off = drop_far(places, line_through(places));
    if (!seen()) return std::nullopt;
    line = line_through(places);
  }
  if (off > kStraight) return std::nullopt;
  return line;
}

std::optional<Point> meet(const Line& a, const Line& b) {
  Eigen::Matrix2d normals;
  normals << a.normal.transpose(), b.normal.transpose();
  if (std::abs(normals.determinant()) < 0.1) return std::nullopt;
  return normals.inverse() * Point(a.normal.dot(a.at), b.normal.dot(b.at));
}

}  // namespace

std::optional<std::array<Eigen::Vector2d, 4>> corners_by_edges(const cv::Mat& grey,
                                                               const FoundMarker& found) {
  constexpr double kFarthest = 4;  // pixels from where the search saw the corner
  const Light light(grey);
  std::array<Point, 4> rough;
  for (std::size_t i = 0; i < 4; ++i) rough[i] = Point(found.corners[i].x, found.corners[i].y);
  // A cell of the marker is black within an edge, and one of paper is white around it.
  const auto apart = [&rough](std::size_t i) {
    const Point along = (rough[(i + 1) % 4] - rough[i]).normalized();
    const Point across(-along.y(), along.x());
    return std::abs(
        across.dot((rough[(i + 2) % 4] + rough[(i + 3) % 4] - rough[i] - rough[(i + 1) % 4]) / 2));
  };
  std::array<Line, 4> edges;
  for (std::size_t i = 0; i < 4; ++i) {
    const double reach = std::clamp(0.75 * apart(i) / 6, 1.5, 3.0);
    const auto edge = find_edge(light, rough[i], rough[(i + 1) % 4], reach);
    if (!edge) return std::nullopt;
    edges[i] = *edge;
  }
  std::array<Point, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto corner = meet(edges[(i + 3) % 4], edges[i]);
    if (!corner || (*corner - rough[i]).norm() > kFarthest) return std::nullopt;
    corners[i] = *corner;
  }
  return corners;
}

}  // namespace artus::kit
