// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/distance_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace artus {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr double kOpeningRatio = 2.3;
constexpr std::uint32_t kLeafBit = 0x80000000U;

// Closest point of a triangle by its Voronoi regions [Ericson2004] section 5.1.5.
double squared_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 ab = t[1] - t[0];
  const Vec3 ac = t[2] - t[0];
  const Vec3 ap = p - t[0];
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Vec3 bp = p - t[1];
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  const Vec3 cp = p - t[2];
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  const double along = d4 - d3;
  if (va <= 0 && along >= 0 && d5 - d6 >= 0) {
    return (bp - along / (along + d5 - d6) * (t[2] - t[1])).squaredNorm();
  }
  const double sum = va + vb + vc;
  return (ap - vb / sum * ab - vc / sum * ac).squaredNorm();
}

// Four numbers in one register.
using Float4 = float __attribute__((vector_size(16)));
using Four = std::array<float, 4>;

Float4 load(const Four& a) {
  return Float4{a[0], a[1], a[2], a[3]};
}

Float4 all(float a) {
  return Float4{a, a, a, a};
}

Float4 smaller(Float4 a, Float4 b) {
  return a < b ? a : b;
}

Float4 larger(Float4 a, Float4 b) {
  return a > b ? a : b;
}

using Float4x3 = std::array<Float4, 3>;

Float4x3 load(const std::array<Four, 3>& a) {
  return {load(a[0]), load(a[1]), load(a[2])};
}

Float4 dot(const Float4x3& a, const Float4x3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

std::array<float, 3> to_float(const Vec3& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

// The squared distance of a point to the triangles of a pack: to the nearest edge, or to the plane
// where the point lies inward of all three.
template <class Pack>
Float4 squared_distances(const Pack& pack, const Vec3& p) {
  const auto at = to_float(p - pack.origin);
  const Float4 zero = all(0);
  Float4 nearest = all(std::numeric_limits<float>::infinity());
  Float4 inmost = nearest;
  Float4x3 from{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Float4x3 start = load(pack.start[k]);
    const Float4x3 edge = load(pack.edge[k]);
    for (std::size_t a = 0; a < 3; ++a) from[a] = all(at[a]) - start[a];
    const Float4 t = smaller(larger(dot(edge, from) * load(pack.inverse[k]), zero), all(1));
    inmost = smaller(inmost, dot(load(pack.inward[k]), from));
    Float4x3 off{};
    for (std::size_t a = 0; a < 3; ++a) off[a] = from[a] - t * edge[a];
    nearest = smaller(nearest, dot(off, off));
  }
  const Float4 height = dot(load(pack.normal), from);
  return inmost > zero ? height * height : nearest;
}

// A sum of angles as a product of complex numbers, and how often it went around: one arc tangent
// for all of them.
class AngleSum {
 public:
  // Adds the angle of (cosine, sine), of any length.
  void add(double cosine, double sine) {
    const double re = re_ * cosine - im_ * sine;
    const double im = re_ * sine + im_ * cosine;
    const double size = std::abs(re) + std::abs(im);
    if (!(size > 0)) return;
    if ((im_ >= 0) == (sine >= 0) && (im >= 0) != (sine >= 0)) turns_ += sine >= 0 ? 1 : -1;
    re_ = re / size;
    im_ = im / size;
  }
  // In turns.
  [[nodiscard]] double turns() const {
    return turns_ + std::atan2(im_, re_) / (2 * std::numbers::pi);
  }

 private:
  double re_ = 1;
  double im_ = 0;
  double turns_ = 0;
};

// Half the signed solid angle [VanOosterom1983] eq. 8.
void add_half_angle(const Vec3& p, const std::array<Vec3, 3>& t, AngleSum& sum) {
  const Vec3 a = t[0] - p;
  const Vec3 b = t[1] - p;
  const Vec3 c = t[2] - p;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  sum.add(la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb, a.dot(b.cross(c)));
}

Vec3 centroid(const std::array<Vec3, 3>& t) {
  return (t[0] + t[1] + t[2]) / 3;
}

}  // namespace

// How many nodes build() makes of so many triangles: known before, so that no vector grows.
std::size_t DistanceTree::Parts::count_nodes(std::size_t triangles) {
  if (triangles <= kLeafSize) return 1;
  return 1 + count_nodes(triangles / 2) + count_nodes(triangles - triangles / 2);
}

DistanceTree::DistanceTree(const SurfaceMesh& mesh) {
  auto parts = std::make_shared<Parts>();
  parts->lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  parts->upper = -parts->lower;
  parts->triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    parts->triangles.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  }
  if (!parts->triangles.empty()) parts->build_all();
  parts_ = std::move(parts);
}

void DistanceTree::Parts::build_all() {
  nodes.reserve(count_nodes(triangles.size()));
  boxes.reserve(nodes.capacity());
  nodes.emplace_back();
  boxes.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(triangles.size()));
  lower = boxes[0].lower;
  upper = boxes[0].upper;
  middle = (lower + upper) / 2;
  const std::size_t n_leaves = (nodes.size() + 1) / 2;
  packs.reserve(n_leaves);
  quads.reserve(n_leaves / 2 + 1);
  flatten(0);
  boxes = std::vector<NodeBox>();
}

DistanceTree::Pack DistanceTree::Parts::make_pack(const Node& leaf) const {
  constexpr double kSliver = 1e-6;  // of the longest edge, the height of one that has no inside
  Pack pack{};
  pack.origin = triangles[leaf.first][0];
  pack.first = leaf.first;
  pack.count = leaf.count;
  for (std::uint32_t i = 0; i < kLeafSize; ++i) {
    const Corners& t = triangles[leaf.first + std::min(i, leaf.count - 1)];
    const Vec3 area_vector = (t[1] - t[0]).cross(t[2] - t[0]);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (t[(k + 1) % 3] - t[k]).norm());
    const bool has_inside = area_vector.norm() > kSliver * longest * longest;
    const Vec3 normal = has_inside ? Vec3(area_vector.normalized()) : Vec3(Vec3::Zero());
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge = t[(k + 1) % 3] - t[k];
      const double length2 = edge.squaredNorm();
      pack.inverse[k][i] = length2 > 0 ? static_cast<float>(1 / length2) : 0;
      if (!std::isfinite(pack.inverse[k][i])) pack.inverse[k][i] = 0;
      const auto start = to_float(t[k] - pack.origin);
      const auto along = to_float(edge);
      const auto inward = to_float(normal.cross(edge).stableNormalized());
      const auto up = to_float(normal);
      for (std::size_t a = 0; a < 3; ++a) {
        pack.start[k][a][i] = start[a];
        pack.edge[k][a][i] = along[a];
        pack.inward[k][a][i] = has_inside ? inward[a] : 0;
        pack.normal[a][i] = up[a];
      }
    }
  }
  return pack;
}

// Makes the quad of a node's children and theirs; returns how it is referred to.
std::uint32_t DistanceTree::Parts::flatten(std::uint32_t node) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (nodes[node].count > 0) {
    packs.push_back(make_pack(nodes[node]));
    return kLeafBit | static_cast<std::uint32_t>(packs.size() - 1);
  }
  std::array<std::uint32_t, 4> children{};
  std::size_t n = 0;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const Node& child = nodes[nodes[node].first + k];
    if (child.count > 0) {
      children[n++] = nodes[node].first + k;
    } else {
      children[n++] = child.first;
      children[n++] = child.first + 1;
    }
  }
  const auto index = static_cast<std::uint32_t>(quads.size());
  quads.emplace_back();
  Quad quad{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      quad.lower[a][k] = kInfinity;
      quad.upper[a][k] = -kInfinity;
      if (k >= n) continue;
      const NodeBox& child = boxes[children[k]];
      quad.lower[a][k] =
          std::nextafter(static_cast<float>(child.lower[axis] - middle[axis]), -kInfinity);
      quad.upper[a][k] =
          std::nextafter(static_cast<float>(child.upper[axis] - middle[axis]), kInfinity);
    }
    if (k < n) quad.to[k] = flatten(children[k]);
  }
  quads[index] = quad;
  return index;
}

void DistanceTree::Parts::summarise(std::uint32_t at, std::uint32_t first, std::uint32_t count) {
  Node& node = nodes[at];
  NodeBox& box = boxes[at];
  box.lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  box.upper = -box.lower;
  double area_sum = 0;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Corners& t = triangles[i];
    for (const Vec3& v : t) {
      box.lower = box.lower.cwiseMin(v);
      box.upper = box.upper.cwiseMax(v);
    }
    const Vec3 area_vector = (t[1] - t[0]).cross(t[2] - t[0]) / 2;
    const double area = area_vector.norm();
    node.dipole += area_vector;
    node.centre += area * centroid(t);
    area_sum += area;
  }
  node.centre = area_sum > 0 ? Vec3(node.centre / area_sum) : Vec3((box.lower + box.upper) / 2);
  const Vec3 reach = (node.centre - box.lower).cwiseMax(box.upper - node.centre);
  node.far2 = kOpeningRatio * kOpeningRatio * reach.squaredNorm();
}

void DistanceTree::Parts::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  summarise(node, first, count);
  if (count <= kLeafSize) {
    nodes[node].first = first;
    nodes[node].count = count;
    return;
  }
  Eigen::Index axis = 0;
  (boxes[node].upper - boxes[node].lower).maxCoeff(&axis);
  const auto begin = triangles.begin() + first;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [axis](const Corners& a, const Corners& b) {
    return centroid(a)[axis] < centroid(b)[axis];
  });
  const auto left = static_cast<std::uint32_t>(nodes.size());
  nodes[node].first = left;
  nodes.resize(nodes.size() + 2);
  boxes.resize(nodes.size());
  build(left, first, half);
  build(left + 1, first + half, count - half);
}

double DistanceTree::distance(const Vec3& p, double bound) const {
  if (empty()) return bound;
  constexpr float kRounding = 0.99999F;  // a box is no farther than that
  const auto at = to_float(p - parts_->middle);
  const Pack* nearest = nullptr;
  float best = static_cast<float>(bound * bound);
  struct Visit {
    float nearest;
    std::uint32_t to;
  };
  std::array<Visit, 64> stack{};
  std::size_t depth = 0;
  stack[depth++] = {0, parts_->quads.empty() ? kLeafBit : 0};
  while (depth > 0) {
    const Visit visit = stack[--depth];
    if (visit.nearest >= best) continue;
    if ((visit.to & kLeafBit) != 0) {
      const Pack& pack = parts_->packs[visit.to & ~kLeafBit];
      const Float4 d = squared_distances(pack, p);
      const float least = std::min(std::min(d[0], d[1]), std::min(d[2], d[3]));
      if (least < best) {
        best = least;
        nearest = &pack;
      }
      continue;
    }
    const Quad& quad = parts_->quads[visit.to];
    Float4 d = all(0);
    for (std::size_t a = 0; a < 3; ++a) {
      const Float4 off = larger(
          larger(load(quad.lower[a]) - all(at[a]), all(at[a]) - load(quad.upper[a])), all(0));
      d += off * off;
    }
    d *= kRounding;
    const std::size_t first = depth;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!(d[k] < best)) continue;
      std::size_t place = depth++;
      for (; place > first && stack[place - 1].nearest < d[k]; --place)
        stack[place] = stack[place - 1];
      stack[place] = {d[k], quad.to[k]};
    }
  }
  if (nearest == nullptr) return bound;
  double exact = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = nearest->first; i < nearest->first + nearest->count; ++i)
    exact = std::min(exact, squared_distance(p, parts_->triangles[i]));
  return std::min(bound, std::sqrt(exact));
}

double DistanceTree::winding_number(const Vec3& p) const {
  if (empty()) return 0;
  double sum = 0;  // of what is far
  AngleSum near;
  std::array<std::uint32_t, 64> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = parts_->nodes[stack[--depth]];
    const Vec3 r = node.centre - p;
    const double r2 = r.squaredNorm();
    if (r2 > node.far2) {
      sum += r.dot(node.dipole) / (4 * std::numbers::pi * r2 * std::sqrt(r2));
    } else if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        add_half_angle(p, parts_->triangles[i], near);
      }
    } else {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
    }
  }
  return sum + near.turns();
}

}  // namespace artus
