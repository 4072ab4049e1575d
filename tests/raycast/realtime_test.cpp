// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/raycast/embree_index.h"
#include "artus/detail/raycast/hit_chain.h"
#include "artus/raycast/scene.h"
#include "tests/raycast/brute_force.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

using test::use;

const Vec3 kCentre(-0.18, -0.05, 1.32);

/// Every real-time query on segments that include edges, planes and vertices of the lattice, whose
/// chains need repair.
double query_all(const Scene& scene, std::uint64_t first, std::uint64_t count) {
  std::array<TissueInterval, 64> intervals;
  std::array<Crossing, 64> crossings;
  double sum = 0;
  for (std::uint64_t i = first; i < first + count; ++i) {
    Segment segment{test::random_point(31, 2 * i, kCentre, 0.07),
                    test::random_point(31, 2 * i + 1, kCentre, 0.07)};
    if (i % 2 == 0) {
      for (Vec3* p : {&segment.start, &segment.end}) {
        *p = kCentre + 0.02 * (((*p - kCentre) / 0.02).array().round().matrix());
      }
    }
    sum += static_cast<double>(scene.find_crossings(segment, crossings).size);
    const QueryCount found = scene.find_intervals(segment, intervals);
    for (std::size_t k = 0; k < found.size; ++k) {
      sum += intervals[k].exit * static_cast<double>(intervals[k].region + 1);
    }
    sum += static_cast<double>(scene.region_at(segment.start));
    sum += scene.find_nearest(segment.end, 1).distance;
    sum += scene.signed_distance_to_skin(segment.end, 1);
  }
  return sum;
}

Scene make_lattice_scene(double jitter) {
  return Scene(std::make_shared<const CompiledJoint>(
      test::make_cell_body(4, 0.02, kCentre, 4, jitter, 21).joint));
}

TEST(RealTimeQueries, NeverAllocateOrLock) {
  const Scene scene = make_lattice_scene(0);
  double sum = 0;
  test::expect_real_time("query_all", [&] { sum = query_all(scene, 0, 5000); });
  EXPECT_GT(sum, 0);
}

TEST(RealTimeQueries, EachOfASceneNeitherAllocatesNorLocks) {
  const Scene scene = make_lattice_scene(0.2);
  std::array<TissueInterval, 64> intervals;
  std::array<Crossing, 64> crossings;
  const Segment segment{kCentre - Vec3(0.07, 0.01, 0.02), kCentre + Vec3(0.07, 0, 0.01)};
  std::size_t found = 0;
  ARTUS_RUNS_REALTIME(Scene::find_crossings, found = scene.find_crossings(segment, crossings).size);
  EXPECT_GT(found, 3U);
  ARTUS_RUNS_REALTIME(Scene::find_intervals, found = scene.find_intervals(segment, intervals).size);
  EXPECT_GT(found, 3U);
  ARTUS_RUNS_REALTIME(Scene::region_at, use(scene.region_at(kCentre)));
  ARTUS_RUNS_REALTIME(Scene::find_nearest, use(scene.find_nearest(kCentre, 1)));
  ARTUS_RUNS_REALTIME(Scene::signed_distance_to_skin,
                      use(scene.signed_distance_to_skin(kCentre, 1)));
  ARTUS_RUNS_REALTIME(Scene::normal_at_rest, use(scene.normal_at_rest(0).x()));
}

TEST(RealTimeQueries, EachOfTheIndexNeitherAllocatesNorLocks) {
  const CompiledJoint joint = test::make_cell_body(4, 0.02, kCentre, 4, 0.2, 21).joint;
  const EmbreeIndex index(
      std::make_shared<const IndexedSurfaces>(joint.mesh.vertices, joint.mesh.interfaces), "");
  const Line line{-0.1 * Vec3::UnitX(), Vec3::UnitX(), 0, 0.2};
  auto buffer = std::make_unique<HitBuffer>();
  ARTUS_RUNS_REALTIME(EmbreeIndex::gather, index.gather(line, *buffer));
  EXPECT_GT(buffer->size, 0U);
  ARTUS_RUNS_REALTIME(EmbreeIndex::first_hit, use(index.first_hit(line)));
  ARTUS_RUNS_REALTIME(EmbreeIndex::nearest,
                      use(index.nearest(Vec3::Zero(), 1, EmbreeIndex::Subset::skin)));
}

TEST(RealTimeQueries, RepairOfAChainNeitherAllocatesNorLocks) {
  // Two facets met at one edge and a hit whose partner is missing.
  std::array<Hit, 4> hits{{{0.03, 3, 3, 2}, {0.01, 1, 0, 2}, {0.01, 0, 2, 3}, {0.05, 4, 3, 0}}};
  ARTUS_RUNS_REALTIME(sort_hits, sort_hits(hits));
  bool chain = true;
  ARTUS_RUNS_REALTIME(is_chain, chain = is_chain(hits));
  EXPECT_FALSE(chain);
  const RegionProbe probe{
      [](const void*, double depth) noexcept { return RegionId(depth < 0.01 ? 0 : 3); }, nullptr};
  auto repaired = std::make_unique<HitChain>();
  ARTUS_RUNS_REALTIME(repair_chain, repair_chain(hits, {0, 0.1, true}, probe, *repaired));
  EXPECT_GT(repaired->size, 0U);
}

TEST(RealTimeQueries, GiveTheSameBytesFromManyThreads) {
  const Scene scene = make_lattice_scene(0.2);
  constexpr std::size_t kThreads = 7;
  constexpr std::uint64_t kQueries = 2000;
  const double expected = query_all(scene, 0, kQueries);
  std::vector<double> sums(kThreads, 0);
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (double& sum : sums) {
    threads.emplace_back([&scene, &sum] { sum = query_all(scene, 0, kQueries); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) EXPECT_EQ(std::memcmp(&sum, &expected, sizeof sum), 0);
}

TEST(LatticeRays, ThroughEdgesAndVerticesStayRight) {
  const auto body = test::make_cell_body(4, 0.02, kCentre, 4, 0, 21);
  const Scene scene(std::make_shared<const CompiledJoint>(body.joint));
  const auto near_label = [&](const Vec3& p, RegionId region) {
    // Right when the region is that of a cell the point lies in or on.
    constexpr double kOn = 1e-6;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 nudge((corner & 1) != 0 ? kOn : -kOn, (corner & 2) != 0 ? kOn : -kOn,
                       (corner & 4) != 0 ? kOn : -kOn);
      const Vec3 at = ((p + nudge - body.low) / body.cell).array().floor();
      if (body.label(static_cast<int>(at.x()), static_cast<int>(at.y()),
                     static_cast<int>(at.z())) == region) {
        return true;
      }
    }
    return false;
  };
  int wrong = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    // Between points of the lattice of half cells: through corners, edge and face centres.
    const auto lattice = [&](std::uint64_t n) -> Vec3 {
      const Vec3 p = test::random_point(33, n, kCentre, 0.055);
      return kCentre + 0.01 * (((p - kCentre) / 0.01).array().round().matrix());
    };
    const Segment segment{lattice(2 * i), lattice(2 * i + 1)};
    const Vec3 along = (segment.end - segment.start).normalized();
    if (!(along.cwiseAbs().minCoeff() > 0)) continue;  // runs within a plane of the lattice
    for (const TissueInterval& interval : tissue_intervals(scene, segment)) {
      if (interval.exit - interval.entry < 1e-5) continue;
      const Vec3 middle = segment.start + 0.5 * (interval.entry + interval.exit) * along;
      wrong += near_label(middle, interval.region) ? 0 : 1;
    }
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace artus
