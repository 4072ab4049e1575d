// SPDX-License-Identifier: AGPL-3.0-or-later
// The distance to a surface: our tree, which gives the winding number from the same nodes, beside
// CGAL's AABB tree. Points lie within a millimetre of the surface (as those of a report) or
// anywhere in twice its box (as those of a coarse field).
#include <array>
#include <cmath>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <benchmark/benchmark.h>

#include "artus/detail/anatomy/surfaces/distance_tree.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using CgalTree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

constexpr double kRadius = 0.05;  // m
constexpr double kFar = 10;       // m, no bound

/// A ball of 160 000 triangles. Ripples make it a surface on which the nearest triangle is not the
/// one below.
SurfaceMesh rippled_ball() {
  constexpr std::uint32_t kRows = 200;
  constexpr std::uint32_t kColumns = 400;
  SurfaceMesh mesh;
  for (std::uint32_t r = 0; r <= kRows; ++r) {
    for (std::uint32_t c = 0; c < kColumns; ++c) {
      const double polar = kTwoPi / 2 * (r + 0.01) / (kRows + 0.02);
      const double around = kTwoPi * c / kColumns;
      const double ripple = 1 + 0.05 * std::sin(20 * polar) * std::sin(20 * around);
      mesh.vertices.push_back(kRadius * ripple *
                              Vec3(std::sin(polar) * std::cos(around),
                                   std::sin(polar) * std::sin(around), std::cos(polar)));
      if (r == kRows) continue;
      const std::uint32_t at = r * kColumns + c;
      const std::uint32_t next = r * kColumns + (c + 1) % kColumns;
      mesh.triangles.push_back({at, at + kColumns, next});
      mesh.triangles.push_back({next, at + kColumns, next + kColumns});
    }
  }
  return mesh;
}

std::vector<Vec3> points(const SurfaceMesh& mesh, bool near) {
  std::vector<Vec3> out(4096);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3 random(uniform_noise(1, 3 * i), uniform_noise(1, 3 * i + 1),
                      uniform_noise(1, 3 * i + 2));
    const Vec3 centred = 2 * random - Vec3::Ones();
    const auto v =
        static_cast<std::size_t>(uniform_noise(2, i) * static_cast<double>(mesh.vertices.size()));
    out[i] = near ? Vec3(mesh.vertices[v] + 1e-3 * centred) : Vec3(2 * kRadius * centred);
  }
  return out;
}

void ours(benchmark::State& state) {
  const SurfaceMesh mesh = rippled_ball();
  const DistanceTree tree(mesh);
  const auto asked = points(mesh, state.range(0) != 0);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(tree.distance(asked[i++ % asked.size()], kFar));
}

void cgal(benchmark::State& state) {
  const SurfaceMesh mesh = rippled_ball();
  Triangles triangles;
  const auto point = [&mesh](std::uint32_t v) {
    const Vec3& p = mesh.vertices[v];
    return Kernel::Point_3(p.x(), p.y(), p.z());
  };
  for (const Triangle& t : mesh.triangles)
    triangles.emplace_back(point(t[0]), point(t[1]), point(t[2]));
  CgalTree tree(triangles.begin(), triangles.end());
  tree.accelerate_distance_queries();
  const auto asked = points(mesh, state.range(0) != 0);
  double off = 0;
  const DistanceTree check(mesh);
  for (const Vec3& p : asked)
    off = std::max(off, std::abs(check.distance(p, kFar) -
                                 std::sqrt(tree.squared_distance({p.x(), p.y(), p.z()}))));
  state.counters["worst difference, m"] = off;
  std::size_t i = 0;
  for (auto _ : state) {
    const Vec3& p = asked[i++ % asked.size()];
    benchmark::DoNotOptimize(tree.squared_distance({p.x(), p.y(), p.z()}));
  }
}

BENCHMARK(ours)->ArgName("near")->Arg(1)->Arg(0);
BENCHMARK(cgal)->ArgName("near")->Arg(1)->Arg(0);

}  // namespace
}  // namespace artus

BENCHMARK_MAIN();
