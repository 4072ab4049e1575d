// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/fit_interfaces.h"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <tbb/parallel_for.h>

namespace artus {
namespace {

constexpr int kSweeps = 4;
constexpr double kLongestStep = 0.3;     // of the shortest interface edge at the vertex
constexpr double kSmallestVolume = 0.4;  // a tetrahedron keeps at least this part of its volume
constexpr double kRankCutoff = 0.15;     // of the largest eigenvalue: directions that count

// Rows of variable length in one array.
struct Incidence {
  std::vector<std::uint32_t> first;  // (n_vertices + 1)
  std::vector<std::uint32_t> items;

  template <class Elements>
  Incidence(std::size_t n_vertices, const Elements& elements) : first(n_vertices + 1, 0) {
    for (const auto& e : elements) {
      for (const std::uint32_t v : e) ++first[v + 1];
    }
    for (std::size_t v = 0; v < n_vertices; ++v) first[v + 1] += first[v];
    items.resize(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    std::uint32_t index = 0;
    for (const auto& e : elements) {
      for (const std::uint32_t v : e) items[next[v]++] = index;
      ++index;
    }
  }
};

// Weighted sums over the quadrature points of one triangle.
struct FacetBalance {
  std::array<double, 3> moment{};  // per corner: integral of hat function times signed distance
  Vec3 normal = Vec3::Zero();      // unit, towards increasing distance
  double area = 0;
};

FacetBalance balance(const TetMesh& mesh, const RegionLabels& labels, const Interface& f) {
  constexpr std::array<std::array<double, 3>, 3> kPoints{
      {{2.0 / 3, 1.0 / 6, 1.0 / 6}, {1.0 / 6, 2.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 6, 2.0 / 3}}};
  const std::array<Vec3, 3> p{mesh.vertices[f.vertices[0]], mesh.vertices[f.vertices[1]],
                              mesh.vertices[f.vertices[2]]};
  FacetBalance b;
  const Vec3 area_vector = (p[1] - p[0]).cross(p[2] - p[0]) / 2;
  b.area = area_vector.norm();
  if (b.area <= 0) return b;
  b.normal = area_vector / b.area;
  const Vec3 centroid = (p[0] + p[1] + p[2]) / 3;
  const double step = 0.1 * std::sqrt(b.area);
  if (labels.separation(f.front, f.back, centroid + step * b.normal) <
      labels.separation(f.front, f.back, centroid - step * b.normal)) {
    b.normal = -b.normal;
  }
  for (const auto& w : kPoints) {
    const double d = labels.separation(f.front, f.back, w[0] * p[0] + w[1] * p[1] + w[2] * p[2]);
    for (std::size_t k = 0; k < 3; ++k) b.moment[k] += b.area / 3 * w[k] * d;
  }
  return b;
}

// The displacement that balances every patch around a vertex in the least-squares sense.
Vec3 wanted_step(const TetMesh& mesh, const Incidence& around,
                 const std::vector<FacetBalance>& balances, std::uint32_t v) {
  struct Patch {
    RegionId a, b;
    double moment = 0;
    double weight = 0;
    Vec3 normal = Vec3::Zero();
  };
  std::vector<Patch> patches;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = around.first[v]; i < around.first[v + 1]; ++i) {
    const Interface& f = mesh.interfaces[around.items[i]];
    const FacetBalance& b = balances[around.items[i]];
    const RegionId low = std::min(f.front, f.back);
    const RegionId high = std::max(f.front, f.back);
    auto patch = std::find_if(patches.begin(), patches.end(),
                              [&](const Patch& p) { return p.a == low && p.b == high; });
    if (patch == patches.end()) patch = patches.insert(patch, Patch{low, high});
    for (std::size_t k = 0; k < 3; ++k) {
      if (f.vertices[k] == v) {
        patch->moment += b.moment[k];
      } else {
        shortest = std::min(shortest, (mesh.vertices[f.vertices[k]] - mesh.vertices[v]).norm());
      }
    }
    patch->weight += b.area / 3;
    patch->normal += b.area * b.normal;
  }
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  for (const Patch& p : patches) {
    if (p.weight <= 0 || p.normal.norm() <= 0) continue;
    const Vec3 n = p.normal.normalized();
    matrix += p.weight * n * n.transpose();
    right -= p.moment * n;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(matrix);
  Vec3 step = Vec3::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()[k] <= kRankCutoff * eigen.eigenvalues()[2]) continue;
    const Vec3 e = eigen.eigenvectors().col(k);
    step += e * (e.dot(right) / eigen.eigenvalues()[k]);
  }
  const double limit = kLongestStep * shortest;
  return step.norm() > limit ? Vec3(step * (limit / step.norm())) : step;
}

// Moves the vertex as far along `step` as its tetrahedra allow.
void move(TetMesh& mesh, const Incidence& tets, const std::vector<double>& smallest,
          std::uint32_t v, Vec3 step) {
  const Vec3 start = mesh.vertices[v];
  for (int attempt = 0; attempt < 3; ++attempt, step /= 2) {
    mesh.vertices[v] = start + step;
    const auto begin = tets.items.begin() + tets.first[v];
    const auto end = tets.items.begin() + tets.first[v + 1];
    if (std::all_of(begin, end,
                    [&](std::uint32_t t) { return tet_volume(mesh, t) > smallest[t]; })) {
      return;
    }
  }
  mesh.vertices[v] = start;
}

// Vertices of the cut by the region of interest stay: nothing is known beyond it that could balance
// them, and no tetrahedron there keeps two folds of the cut from passing through each other.
std::vector<bool> find_fixed_vertices(const TetMesh& mesh) {
  std::vector<bool> fixed(mesh.vertices.size(), false);
  for (const Interface& f : mesh.interfaces) {
    if (f.front != kBeyond && f.back != kBeyond) continue;
    for (const std::uint32_t v : f.vertices) fixed[v] = true;
  }
  return fixed;
}

}  // namespace

void fit_interfaces(TetMesh& mesh, const RegionLabels& labels) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(mesh.interfaces.size());
  for (const Interface& f : mesh.interfaces) triangles.push_back(f.vertices);
  const Incidence around(mesh.vertices.size(), triangles);
  const Incidence tets(mesh.vertices.size(), mesh.tetrahedra);
  std::vector<double> smallest(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < smallest.size(); ++t) {
    smallest[t] = kSmallestVolume * tet_volume(mesh, t);
  }
  const std::vector<bool> fixed = find_fixed_vertices(mesh);
  std::vector<FacetBalance> balances(mesh.interfaces.size());
  std::vector<Vec3> steps(mesh.vertices.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    tbb::parallel_for(std::size_t{0}, balances.size(), [&](std::size_t i) {
      balances[i] = balance(mesh, labels, mesh.interfaces[i]);
    });
    tbb::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t v) {
      const auto vertex = static_cast<std::uint32_t>(v);
      steps[v] = fixed[v] || around.first[v] == around.first[v + 1]
                     ? Vec3(Vec3::Zero())
                     : wanted_step(mesh, around, balances, vertex);
    });
    for (std::uint32_t v = 0; v < steps.size(); ++v) {
      if (steps[v] != Vec3::Zero()) move(mesh, tets, smallest, v, steps[v]);
    }
  }
}

}  // namespace artus
