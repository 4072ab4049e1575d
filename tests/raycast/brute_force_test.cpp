// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/raycast/brute_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "artus/raycast/scene.h"
#include "tests/support/layered_body.h"
#include "tests/support/trials.h"

namespace artus {
namespace {

const Vec3 kFarOrigin(-0.18, -0.05, 1.32);

struct Comparison {
  long queries = 0;
  long different = 0;  // other regions along the segment
  long undecided = 0;  // no brute-force crossing: nothing to compare with
  double worst = 0;    // m, of the depths
  long coarse = 0;     // depths off by more than 1e-9 m
};

/// Intervals against all triangles on random segments through the cube `centre` +- `half`.
Comparison compare(const CompiledJoint& joint, const Vec3& centre, double half, int segments,
                   std::uint64_t seed) {
  const Scene scene(std::make_shared<const CompiledJoint>(joint));
  Comparison comparison;
  for (int i = 0; i < test::trials(segments); ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    const Segment segment{test::random_point(seed, 2 * n, centre, half),
                          test::random_point(seed, 2 * n + 1, centre, half)};
    const auto crossings = test::brute_force_crossings(joint.mesh, segment);
    if (crossings.empty()) {
      ++comparison.undecided;
      continue;
    }
    const double length = (segment.end - segment.start).norm();
    const auto expected = test::stretches(crossings, length, 2e-7);
    const auto actual = test::stretches(tissue_intervals(scene, segment), 2e-7);
    ++comparison.queries;
    const bool same = std::equal(
        expected.begin(), expected.end(), actual.begin(), actual.end(),
        [](const test::Stretch& a, const test::Stretch& b) { return a.region == b.region; });
    if (!same) {
      ++comparison.different;
      continue;
    }
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const double error = std::abs(expected[k].entry - actual[k].entry);
      comparison.worst = std::max(comparison.worst, error);
      comparison.coarse += error > 1e-9 ? 1 : 0;
    }
  }
  return comparison;
}

TEST(FindIntervals, AgreesWithAllTrianglesOfNestedSpheresFarFromTheOrigin) {
  const std::array<test::SphereLayer, 5> layers{
      {{"skin", 0.06}, {"fat", 0.058}, {"muscle", 0.045}, {"tendon", 0.03}, {"bone", 0.02}}};
  const CompiledJoint joint = test::make_nested_spheres(layers, kFarOrigin, 2);
  const Comparison result = compare(joint, kFarOrigin, 0.08, 100'000, 11);
  EXPECT_GT(result.queries, test::trials(70'000));
  EXPECT_EQ(result.different, 0);
  EXPECT_LT(result.worst, 5e-8);  // within 10 nm of an edge the neighbour's plane may be taken
  EXPECT_LE(result.coarse, 5);
}

TEST(FindIntervals, AgreesWithAllTrianglesWhereManyRegionsMeet) {
  const auto body = test::make_cell_body(5, 0.02, kFarOrigin, 5, 0.2, 7);
  const Comparison result = compare(body.joint, kFarOrigin, 0.07, 100'000, 12);
  EXPECT_GT(result.queries, test::trials(80'000));
  EXPECT_EQ(result.different, 0);
  EXPECT_LT(result.worst, 5e-8);  // within 10 nm of an edge the neighbour's plane may be taken
  EXPECT_LE(result.coarse, 5);
}

TEST(FindNearest, AgreesWithAllTriangles) {
  const auto body = test::make_cell_body(5, 0.02, kFarOrigin, 5, 0.2, 8);
  const Scene scene(std::make_shared<const CompiledJoint>(body.joint));
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(test::trials(5000)); ++i) {
    const Vec3 p = test::random_point(13, i, kFarOrigin, 0.08);
    const double expected = test::brute_force_distance(body.joint.mesh, p);
    const NearestInterface nearest = scene.find_nearest(p, 1);
    EXPECT_NEAR(nearest.distance, expected, 1e-12);
    EXPECT_NEAR((nearest.point - p).norm(), expected, 1e-12);
    EXPECT_TRUE(std::isinf(scene.find_nearest(p, 0.999 * expected).distance));
  }
}

TEST(RegionAt, AgreesWithTheFirstCrossingOfAnyLineFromThePoint) {
  const auto body = test::make_cell_body(5, 0.02, kFarOrigin, 5, 0.2, 9);
  const Scene scene(std::make_shared<const CompiledJoint>(body.joint));
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const Vec3 p = test::random_point(14, 2 * i, kFarOrigin, 0.06);
    const Vec3 far = p + test::random_point(14, 2 * i + 1, Vec3::Zero(), 1);
    const auto crossings = test::brute_force_crossings(body.joint.mesh, {p, far});
    EXPECT_EQ(scene.region_at(p), crossings.empty() ? kOutside : crossings.front().from);
  }
}

TEST(RegionAt, IsRightWithinNanometresOfAnInterface) {
  const auto body = test::make_cell_body(5, 0.02, kFarOrigin, 5, 0.2, 10);
  const Scene scene(std::make_shared<const CompiledJoint>(body.joint));
  const TetMesh& mesh = body.joint.mesh;
  for (const Interface& face : mesh.interfaces) {
    const Vec3& a = mesh.vertices[face.vertices[0]];
    const Vec3& b = mesh.vertices[face.vertices[1]];
    const Vec3& c = mesh.vertices[face.vertices[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    for (const Vec3& weight : {Vec3(0.3, 0.3, 0.4), Vec3(0.0005, 0.0005, 0.999)}) {
      const Vec3 q = weight.x() * a + weight.y() * b + weight.z() * c;
      EXPECT_EQ(scene.region_at(q + 2e-9 * normal), face.front);
      EXPECT_EQ(scene.region_at(q - 2e-9 * normal), face.back);
    }
  }
}

TEST(SignedDistanceToSkin, HasTheSignOfTheRegionAndTheDistanceOfTheSkin) {
  const auto body = test::make_cell_body(4, 0.02, kFarOrigin, 4, 0.2, 15);
  const Scene scene(std::make_shared<const CompiledJoint>(body.joint));
  TetMesh skin = body.joint.mesh;
  std::erase_if(skin.interfaces, [](const Interface& face) {
    return face.front != kOutside && face.back != kOutside;
  });
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(test::trials(5000)); ++i) {
    const Vec3 p = test::random_point(16, i, kFarOrigin, 0.08);
    const double distance = scene.signed_distance_to_skin(p, 1);
    EXPECT_NEAR(std::abs(distance), test::brute_force_distance(skin, p), 1e-12);
    EXPECT_EQ(distance > 0, scene.region_at(p) == kOutside);
  }
}

}  // namespace
}  // namespace artus
