// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/enclosed_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace artus {
namespace {

constexpr int kLines = 200;  // on each side of the box's smallest face

/// Where a line passes through the surface.
struct Crossing {
  int line = 0;
  double depth = 0;  // m
  int turn = 0;      // +1 into the surface, -1 out of it
};

/// Lines along the longest side of a mesh's box, through the middles of a grid across it.
class Lines {
 public:
  explicit Lines(const SurfaceMesh& mesh) : mesh_(mesh) {
    Eigen::AlignedBox3d box;
    for (const Triangle& t : mesh.triangles)
      for (const auto v : t) box.extend(mesh.vertices[v]);
    if (box.isEmpty()) return;
    Eigen::Index longest = 0;
    box.sizes().maxCoeff(&longest);
    axes_ = {(longest + 1) % 3, (longest + 2) % 3, longest};
    lower_ = {box.min()[axes_[0]], box.min()[axes_[1]]};
    step_ = {box.sizes()[axes_[0]] / kLines, box.sizes()[axes_[1]] / kLines};
  }
  [[nodiscard]] double area_of_each() const { return step_.prod(); }

  /// All crossings, line by line, each from its start.
  [[nodiscard]] std::vector<Crossing> cross() const {
    std::vector<Crossing> crossings;
    for (const Triangle& t : mesh_.triangles) append(t, crossings);
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
      return a.line != b.line ? a.line < b.line : a.depth < b.depth;
    });
    return crossings;
  }

 private:
  using Vec2 = Eigen::Vector2d;

  [[nodiscard]] Vec2 across(const Vec3& p) const { return {p[axes_[0]], p[axes_[1]]}; }
  static double turn(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

  void append(const Triangle& t, std::vector<Crossing>& crossings) const {
    std::array<Vec2, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = across(mesh_.vertices[t[k]]);
    const double area = turn(p[1] - p[0], p[2] - p[0]);
    if (area == 0) return;
    std::array<std::array<int, 2>, 2> range{};  // (side, first and last line)
    for (Eigen::Index a = 0; a < 2; ++a) {
      const auto [min, max] = std::minmax({p[0][a], p[1][a], p[2][a]});
      range[static_cast<std::size_t>(a)] = {
          std::max(0, static_cast<int>(std::ceil((min - lower_[a]) / step_[a] - 0.5))),
          std::min(kLines - 1, static_cast<int>(std::floor((max - lower_[a]) / step_[a] - 0.5)))};
    }
    for (int j = range[1][0]; j <= range[1][1]; ++j)
      for (int i = range[0][0]; i <= range[0][1]; ++i) {
        const Vec2 q = lower_ + step_.cwiseProduct(Vec2(i + 0.5, j + 0.5));
        Vec3 weight;
        for (std::size_t k = 0; k < 3; ++k)
          weight[static_cast<Eigen::Index>(k)] =
              turn(p[(k + 1) % 3] - q, p[(k + 2) % 3] - q) / area;
        if (weight.minCoeff() < 0) continue;
        double depth = 0;
        for (std::size_t k = 0; k < 3; ++k)
          depth += weight[static_cast<Eigen::Index>(k)] * mesh_.vertices[t[k]][axes_[2]];
        crossings.push_back({j * kLines + i, depth, area < 0 ? 1 : -1});
      }
  }

  const SurfaceMesh& mesh_;
  std::array<Eigen::Index, 3> axes_{0, 1, 2};
  Vec2 lower_ = Vec2::Zero();
  Vec2 step_ = Vec2::Zero();
};

}  // namespace

double enclosed_volume(const SurfaceMesh& mesh) {
  const Lines lines(mesh);
  const std::vector<Crossing> crossings = lines.cross();
  double too_often = 0;  // m, over all lines
  for (std::size_t first = 0; first < crossings.size();) {
    std::size_t end = first;
    int winding = 0;
    double on_line = 0;
    for (; end < crossings.size() && crossings[end].line == crossings[first].line; ++end) {
      if (end > first) {
        const int counted = winding > 0 ? winding - 1 : winding;
        on_line += counted * (crossings[end].depth - crossings[end - 1].depth);
      }
      winding += crossings[end].turn;
    }
    if (winding == 0) too_often += on_line;  // else the line runs through an edge
    first = end;
  }
  return signed_volume(mesh) - too_often * lines.area_of_each();
}

}  // namespace artus
