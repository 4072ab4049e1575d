// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/raycast/scene.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "tests/support/layered_body.h"

namespace artus {
namespace {

using test::FlatLayer;
using test::SphereLayer;
using ::testing::ElementsAre;

const Vec3 kFarAway(-0.18, -0.05, 1.32);

Scene make_scene(const CompiledJoint& joint) {
  return Scene(std::make_shared<const CompiledJoint>(joint));
}

CompiledJoint make_slab() {
  const std::array<FlatLayer, 3> layers{{{"skin", 0.002}, {"fat", 0.008}, {"muscle", 0.03}}};
  return test::make_layered_block(layers, 0.1, 0.08, kFarAway);
}

std::vector<RegionId> regions_of(const std::vector<TissueInterval>& intervals) {
  std::vector<RegionId> regions;
  for (const TissueInterval& interval : intervals) regions.push_back(interval.region);
  return regions;
}

TEST(FindIntervals, CutsALineThroughASlabAtItsLayers) {
  const Scene scene = make_scene(make_slab());
  const Vec3 start = kFarAway + Vec3(0.0123, 0.0071, -0.01);
  const auto intervals = tissue_intervals(scene, {start, start + Vec3(0, 0, 0.1)});
  ASSERT_THAT(regions_of(intervals), ElementsAre(0, 2, 3, 4, 0));
  const std::array<double, 6> expected{0, 0.01, 0.012, 0.02, 0.05, 0.1};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(intervals[i].entry, expected[i], 1e-12);
    EXPECT_NEAR(intervals[i].exit, expected[i + 1], 1e-12);
  }
  EXPECT_EQ(intervals[0].entry_normal, Vec3::Zero());
  EXPECT_LT((intervals[2].entry_normal - Vec3(0, 0, -1)).norm(), 1e-12);
}

TEST(FindIntervals, DoesNotMindEdgesAndVerticesOfASlab) {
  const Scene scene = make_scene(make_slab());
  // The faces' diagonals cross at x/y = 0.1/0.08; the corners are vertices, the sides shared edges.
  const std::array<Vec3, 3> starts{Vec3(0, 0, -0.01), Vec3(0.025, -0.02, -0.01),
                                   Vec3(0.025, 0.02, -0.01)};
  for (const Vec3& offset : starts) {
    const Vec3 start = kFarAway + offset;
    const auto intervals = tissue_intervals(scene, {start, start + Vec3(0, 0, 0.1)});
    EXPECT_THAT(regions_of(intervals), ElementsAre(0, 2, 3, 4, 0));
    std::array<Crossing, 16> crossings;
    EXPECT_EQ(scene.find_crossings({start, start + Vec3(0, 0, 0.1)}, crossings).size, 4U);
  }
}

TEST(FindIntervals, ThroughOppositeCornersEntersAndLeavesTheBlockOnce) {
  const std::array<FlatLayer, 1> layer{{{"muscle", 0.1}}};
  const Scene scene = make_scene(test::make_layered_block(layer, 0.1, 0.1, kFarAway));
  const Vec3 corner = kFarAway + Vec3(-0.05, -0.05, 0);
  const Vec3 along = Vec3(1, 1, 1);
  const auto intervals = tissue_intervals(scene, {corner - 0.03 * along, corner + 0.13 * along});
  ASSERT_THAT(regions_of(intervals), ElementsAre(0, 2, 0));
  EXPECT_NEAR(intervals[1].entry, 0.03 * std::sqrt(3), 1e-8);
  EXPECT_NEAR(intervals[1].exit, 0.13 * std::sqrt(3), 1e-8);
}

TEST(FindIntervals, StartInsideHasNoEntryNormal) {
  const Scene scene = make_scene(make_slab());
  const Vec3 start = kFarAway + Vec3(0.01, 0.005, 0.005);
  const auto intervals = tissue_intervals(scene, {start, start + Vec3(0, 0, 0.01)});
  ASSERT_THAT(regions_of(intervals), ElementsAre(3, 4));
  EXPECT_EQ(intervals[0].entry_interface, kNoInterface);
  EXPECT_EQ(intervals[0].entry_normal, Vec3::Zero());
  EXPECT_NEAR(intervals[1].entry, 0.005, 1e-12);
}

TEST(FindIntervals, ASegmentThatStaysInOneTissueIsOneInterval) {
  const Scene scene = make_scene(make_slab());
  const Vec3 start = kFarAway + Vec3(0.01, 0.005, 0.02);
  const auto intervals = tissue_intervals(scene, {start, start + Vec3(0.01, 0, 0.01)});
  ASSERT_THAT(regions_of(intervals), ElementsAre(4));
  EXPECT_EQ(intervals[0].entry, 0);
  EXPECT_NEAR(intervals[0].exit, std::hypot(0.01, 0.01), 1e-15);
}

TEST(FindIntervals, StartOnAnInterfaceCrossesItAndEndOnItDoesNot) {
  const std::array<FlatLayer, 2> layers{{{"skin", 0.25}, {"fat", 0.25}}};
  const Scene scene = make_scene(test::make_layered_block(layers, 1, 1));
  const Vec3 on_skin(0.125, 0.0625, 0);
  const auto inward = tissue_intervals(scene, {on_skin, on_skin + Vec3(0, 0, 0.25)});
  ASSERT_THAT(regions_of(inward), ElementsAre(2));
  EXPECT_EQ(inward[0].entry, 0);
  EXPECT_EQ(inward[0].entry_normal, Vec3(0, 0, -1));
  std::array<Crossing, 4> crossings;
  EXPECT_EQ(scene.find_crossings({on_skin, on_skin + Vec3(0, 0, 0.25)}, crossings).size, 1U);
  const auto outward = tissue_intervals(scene, {on_skin + Vec3(0, 0, 0.125), on_skin});
  EXPECT_THAT(regions_of(outward), ElementsAre(2));
  const auto away = tissue_intervals(scene, {on_skin, on_skin - Vec3(0, 0, 0.125)});
  EXPECT_THAT(regions_of(away), ElementsAre(0));
}

TEST(FindIntervals, ZeroLengthSegmentIsTheRegionAtItsPoint) {
  const Scene scene = make_scene(make_slab());
  const Vec3 p = kFarAway + Vec3(0.01, 0.005, 0.001);
  const auto intervals = tissue_intervals(scene, {p, p});
  ASSERT_THAT(regions_of(intervals), ElementsAre(2));
  EXPECT_EQ(intervals[0].entry, 0);
  EXPECT_EQ(intervals[0].exit, 0);
  std::array<Crossing, 4> crossings;
  EXPECT_EQ(scene.find_crossings({p, p}, crossings).size, 0U);
}

TEST(FindIntervals, OutsideTheBodyIsOneOutsideInterval) {
  const Scene scene = make_scene(make_slab());
  const Vec3 near = kFarAway + Vec3(0, 0, -0.001);
  EXPECT_THAT(regions_of(tissue_intervals(scene, {near, near + Vec3(0.02, 0.01, 0)})),
              ElementsAre(0));
  const Vec3 far = kFarAway + Vec3(100, 0, 0);
  EXPECT_THAT(regions_of(tissue_intervals(scene, {far, far + Vec3(1, 0, 0)})), ElementsAre(0));
}

TEST(FindIntervals, ANeedleAlongAnInterfaceIsInOneOfItsTissuesAllTheWay) {
  const Scene scene = make_scene(make_slab());
  for (const double lift : {0.0, 1e-9, -1e-9, 1e-10}) {
    const Vec3 start = kFarAway + Vec3(-0.07, 0.003, 0.002 + lift);
    const auto regions = regions_of(tissue_intervals(scene, {start, start + Vec3(0.14, 0.001, 0)}));
    ASSERT_EQ(regions.size(), 3U) << lift;
    EXPECT_EQ(regions.front(), kOutside);
    EXPECT_TRUE(regions[1] == 2 || regions[1] == 3);
    EXPECT_EQ(regions.back(), kOutside);
  }
}

TEST(FindIntervals, CoordinatesThatAreNotFiniteFindNothing) {
  const Scene scene = make_scene(make_slab());
  const Vec3 bad(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  EXPECT_TRUE(tissue_intervals(scene, {bad, kFarAway}).empty());
  EXPECT_TRUE(tissue_intervals(scene, {kFarAway, bad}).empty());
  EXPECT_EQ(scene.region_at(bad), kOutside);
  EXPECT_TRUE(std::isinf(scene.find_nearest(bad, 1).distance));
}

TEST(FindIntervals, NestedSpheresApproachTheClosedForm) {
  const std::array<SphereLayer, 3> layers{{{"skin", 0.06}, {"muscle", 0.05}, {"bone", 0.03}}};
  const Scene scene = make_scene(test::make_nested_spheres(layers, kFarAway, 5));
  // A facet with circumradius c lies c^2/(2r) below the sphere it is inscribed in; edges of an
  // icosahedron split 5 times stay below 0.04 r, so c < 0.0231 r. Obliquely the depth moves by that
  // over the cosine.
  for (const double offset : {0.0, 0.01, 0.02, 0.027}) {
    const Vec3 start = kFarAway + Vec3(0.3, offset, 0.0003);
    const auto intervals = tissue_intervals(scene, {start, start - Vec3(0.6, 0, 0)});
    ASSERT_THAT(regions_of(intervals), ElementsAre(0, 2, 3, 4, 3, 2, 0));
    for (std::size_t i = 0; i < 3; ++i) {
      const double r = layers[i].radius;
      const double half = std::sqrt(r * r - offset * offset - 0.0003 * 0.0003);
      const double tolerance = 0.5 * 0.0231 * 0.0231 * r / (half / r);
      EXPECT_NEAR(intervals[i + 1].entry, 0.3 - half, tolerance);
      EXPECT_NEAR(intervals[6 - i].entry, 0.3 + half, tolerance);
      EXPECT_GE(intervals[i + 1].entry, 0.3 - half - 1e-12);
    }
  }
}

TEST(FindIntervals, GrazingRaysKeepAConsistentChain) {
  const std::array<SphereLayer, 3> layers{{{"skin", 0.06}, {"muscle", 0.059}, {"bone", 0.03}}};
  const CompiledJoint joint = test::make_nested_spheres(layers, kFarAway, 3);
  const Scene scene = make_scene(joint);
  // Lines through every vertex of the middle sphere, tangent to it.
  const std::size_t per_sphere = joint.mesh.vertices.size() / 3;
  for (std::size_t i = per_sphere; i < 2 * per_sphere; ++i) {
    const Vec3& vertex = joint.mesh.vertices[i];
    const Vec3 tangent = (vertex - kFarAway).unitOrthogonal();
    const auto regions =
        regions_of(tissue_intervals(scene, {vertex - 0.1 * tangent, vertex + 0.1 * tangent}));
    ASSERT_GE(regions.size(), 3U);
    EXPECT_EQ(regions.front(), kOutside);
    EXPECT_EQ(regions.back(), kOutside);
    const auto shell = [](RegionId region) {
      return region == kOutside ? 1 : int{region};
    };
    for (std::size_t k = 1; k < regions.size(); ++k) {
      EXPECT_EQ(std::abs(shell(regions[k]) - shell(regions[k - 1])), 1);
    }
  }
}

TEST(FindIntervals, ANeedleThatLeavesAsBeyondMayReturnAsOutside) {
  std::array<FlatLayer, 2> layers{{{"skin", 0.01}, {"fat", 0.01}}};
  CompiledJoint joint = test::make_layered_block(layers, 0.1, 0.1);
  // All but the top face border the unmeshed part of the body.
  for (Interface& face : joint.mesh.interfaces) {
    const bool top = joint.mesh.vertices[face.vertices[0]].z() == 0 &&
                     joint.mesh.vertices[face.vertices[1]].z() == 0 &&
                     joint.mesh.vertices[face.vertices[2]].z() == 0;
    if (!top && face.front == kOutside) face.front = kBeyond;
  }
  const Scene scene = make_scene(joint);
  EXPECT_THAT(regions_of(tissue_intervals(scene, {Vec3(0.01, 0.02, -0.01), Vec3(0.01, 0.02, 1)})),
              ElementsAre(0, 2, 3, kBeyond));
  EXPECT_EQ(scene.region_at(Vec3(0, 0, -0.05)), kOutside);
  EXPECT_EQ(scene.region_at(Vec3(0, 0, 0.05)), kBeyond);
  EXPECT_EQ(scene.region_at(Vec3(0.2, 0, 0.01)), kBeyond);
  EXPECT_GT(scene.signed_distance_to_skin(Vec3(0, 0, -0.05), 1), 0);
  EXPECT_NEAR(scene.signed_distance_to_skin(Vec3(0, 0, 0.015), 1), -0.015, 1e-12);
}

TEST(FindIntervals, ATooSmallSpanKeepsTheNearest) {
  const Scene scene = make_scene(make_slab());
  const Vec3 start = kFarAway + Vec3(0.0123, 0.0071, -0.01);
  const Segment segment{start, start + Vec3(0, 0, 0.1)};
  std::array<TissueInterval, 2> two;
  const QueryCount count = scene.find_intervals(segment, two);
  EXPECT_TRUE(count.truncated);
  ASSERT_EQ(count.size, 2U);
  EXPECT_EQ(two[0].region, 0);
  EXPECT_EQ(two[1].region, 2);
  EXPECT_NEAR(two[1].exit, 0.012, 1e-12);
  std::array<Crossing, 1> one;
  EXPECT_TRUE(scene.find_crossings(segment, one).truncated);
  EXPECT_NEAR(one[0].depth, 0.01, 1e-12);
  EXPECT_TRUE(scene.find_intervals(segment, {}).truncated);
  std::array<TissueInterval, 5> five;
  EXPECT_FALSE(scene.find_intervals(segment, five).truncated);
}

TEST(FindCrossings, MoreSurfacesThanAQueryHoldsKeepsTheNearestAndSaysSo) {
  const std::vector<FlatLayer> layers(300, FlatLayer{"muscle", 1e-3});
  const Scene scene = make_scene(test::make_layered_block(layers, 0.1, 0.1));
  const Segment segment{Vec3(0.011, 0.007, -0.01), Vec3(0.011, 0.007, 0.5)};
  std::vector<Crossing> crossings(600);
  const QueryCount count = scene.find_crossings(segment, crossings);
  EXPECT_TRUE(count.truncated);
  ASSERT_GE(count.size, 200U);
  for (std::size_t i = 0; i < count.size; ++i) {
    EXPECT_NEAR(crossings[i].depth, 0.01 + 1e-3 * static_cast<double>(i), 1e-9);
  }
}

TEST(FindCrossings, NormalsOpposeTravelAndRegionsChain) {
  const std::array<SphereLayer, 3> layers{{{"skin", 0.06}, {"muscle", 0.05}, {"bone", 0.03}}};
  const Scene scene = make_scene(test::make_nested_spheres(layers, kFarAway, 3));
  const Segment segment{kFarAway + Vec3(0.1, 0.004, 0.003), kFarAway - Vec3(0.1, 0.002, 0.001)};
  const Vec3 along = (segment.end - segment.start).normalized();
  std::array<Crossing, 16> crossings;
  const QueryCount count = scene.find_crossings(segment, crossings);
  ASSERT_EQ(count.size, 6U);
  for (std::size_t i = 0; i < count.size; ++i) {
    EXPECT_LT(crossings[i].normal.dot(along), 0);
    EXPECT_NEAR(crossings[i].normal.norm(), 1, 1e-12);
    if (i > 0) {
      EXPECT_EQ(crossings[i].from, crossings[i - 1].to);
    }
  }
}

TEST(FindIntervals, MoveRigidlyWithTheBody) {
  const std::array<SphereLayer, 3> layers{{{"skin", 0.06}, {"muscle", 0.05}, {"bone", 0.03}}};
  const CompiledJoint joint = test::make_nested_spheres(layers, Vec3::Zero(), 3);
  const Pose motion = make_pose(kFarAway, Vec3(1, -2, 0.7), Vec3(0.3, 1, 1));
  const Scene here = make_scene(joint);
  const Scene there = make_scene(test::transformed(joint, motion));
  for (int i = 0; i < 500; ++i) {
    const Segment segment{Vec3(0.07, 0.0002 * i - 0.05, 0.01), Vec3(-0.06, 0.02, 0.0001 * i)};
    const auto a = tissue_intervals(here, segment);
    const auto b = tissue_intervals(there, {motion * segment.start, motion * segment.end});
    ASSERT_EQ(regions_of(a), regions_of(b));
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_NEAR(a[k].entry, b[k].entry, 1e-9);
      EXPECT_LT((motion.linear() * a[k].entry_normal - b[k].entry_normal).norm(), 1e-9);
    }
  }
}

TEST(Scene, RefusesWhatItsCallerGotWrong) {
  EXPECT_THROW(Scene(nullptr), std::invalid_argument);
  const auto joint = std::make_shared<const CompiledJoint>(make_slab());
  EXPECT_THROW(Scene(joint, {"i386"}), std::invalid_argument);
  CompiledJoint same_sides = make_slab();
  same_sides.mesh.interfaces[0].front = same_sides.mesh.interfaces[0].back;
  EXPECT_THROW(make_scene(same_sides), std::invalid_argument);
  CompiledJoint bad_index = make_slab();
  bad_index.mesh.interfaces[0].vertices[1] = 12345;
  EXPECT_THROW(make_scene(bad_index), std::invalid_argument);
}

TEST(Scene, WithoutInterfacesIsOutsideEverywhere) {
  const Scene scene = make_scene(CompiledJoint{});
  EXPECT_THAT(regions_of(tissue_intervals(scene, {Vec3::Zero(), Vec3::Ones()})), ElementsAre(0));
  EXPECT_EQ(scene.region_at(Vec3::Zero()), kOutside);
  EXPECT_TRUE(std::isinf(scene.find_nearest(Vec3::Zero(), 1).distance));
}

}  // namespace
}  // namespace artus
