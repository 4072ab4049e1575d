// SPDX-License-Identifier: AGPL-3.0-or-later
// The three steps from labels to well-shaped tetrahedra, on a ball in a ball.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/compile/labels/fit_interfaces.h"
#include "artus/detail/anatomy/compile/labels/quality.h"
#include "artus/detail/anatomy/compile/labels/resolve.h"
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"
#include "artus/detail/anatomy/compile/mesh/tetrahedralize.h"
#include "tests/anatomy/compile/balls_joint.h"
#include "tests/anatomy/compile/tet_samples.h"

namespace artus {
namespace {

using test::ball_volume;

constexpr double kBody = 12e-3;      // m
constexpr double kInside = 6e-3;     // m
constexpr RegionId kBallRegion = 3;  // behind the filler

RegionLabels make_labels() {
  const FieldSampling sampling{{Vec3::Constant(-14e-3), Vec3::Constant(14e-3)}, 0.4e-3, 2e-3};
  const auto ball = [&](double radius) {
    return DistanceField::compute([radius](const Vec3& p) { return p.norm() - radius; }, sampling);
  };
  RegionLabels labels;
  labels.body = ball(kBody);
  labels.layers.push_back({kBallRegion, ball(kInside)});
  return labels;
}

ResolveOptions make_options() {
  ResolveOptions options;
  options.box = {Vec3::Constant(-13.5e-3), Vec3::Constant(13.5e-3)};
  options.sizing.assign(4, {2.5e-3, 0.15e-3, 5e-3});
  options.seed_spacing = 1e-3;
  return options;
}

void finish(TetMesh& mesh) {
  rebuild_interfaces(mesh, *find_tet_neighbours(mesh), [](const Vec3&) { return kOutside; });
  order_vertices(mesh);
}

/// What resolving gives, made once.
const TetMesh& resolved() {
  static const TetMesh mesh = [] {
    auto result = resolve_regions(make_labels(), make_options());
    if (!result) throw std::runtime_error(result.error().to_string());
    finish(*result);
    return std::move(*result);
  }();
  return mesh;
}

TEST(ResolveRegions, FillsBothBallsWithPositiveTetrahedraOnBothSidesOfOneSurface) {
  const TetMesh& mesh = resolved();
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) ASSERT_GT(tet_volume(mesh, t), 0);
  const auto volumes = region_volumes(mesh, 4);
  EXPECT_NEAR(volumes[kBallRegion], ball_volume(kInside), 0.08 * ball_volume(kInside));
  EXPECT_NEAR(volumes[kFirstRegion] + volumes[kBallRegion], ball_volume(kBody),
              0.05 * ball_volume(kBody));
  for (const Interface& f : mesh.interfaces) {
    const double radius = f.front == kOutside ? kBody : kInside;
    for (const std::uint32_t v : f.vertices) EXPECT_NEAR(mesh.vertices[v].norm(), radius, 0.1e-3);
  }
}

TEST(ResolveRegions, NothingInsideIsRefused) {
  RegionLabels labels = make_labels();
  ResolveOptions options = make_options();
  options.box = {Vec3::Constant(0.1), Vec3::Constant(0.12)};
  const auto mesh = resolve_regions(labels, options);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::failed);
}

TEST(ResolveRegions, SizesThatAreNotPositiveAreTheCallersMistake) {
  ResolveOptions options = make_options();
  options.seed_spacing = 0;
  EXPECT_THROW(static_cast<void>(resolve_regions(make_labels(), options)), std::invalid_argument);
}

TEST(FitInterfaces, GivesConvexPartsTheVolumeThatTheirFlatFacetsCutOff) {
  TetMesh mesh = resolved();
  const double before = region_volumes(mesh, 4)[kBallRegion];
  fit_interfaces(mesh, make_labels());
  const double after = region_volumes(mesh, 4)[kBallRegion];
  const double exact = ball_volume(kInside);
  EXPECT_LT(before, 0.99 * exact) << "vertices on the ball, triangles inside it";
  EXPECT_NEAR(after, exact, 0.005 * exact);
  EXPECT_EQ(compute_quality(mesh).inverted, 0U);
}

TEST(FitInterfaces, MovesAPlaneWhereItsLabelsHaveIt) {
  constexpr double kSide = 0.04;
  constexpr double kOff = 1e-3;
  TetMesh mesh = test::make_body_of_tets(4, kSide, [](const Vec3& p) -> RegionId {
    return p.x() < kSide / 2 ? kBallRegion : kFirstRegion;
  });
  const FieldSampling sampling{{Vec3::Constant(-0.01), Vec3::Constant(0.05)}, 1e-3, 6e-3};
  RegionLabels labels;
  labels.body = DistanceField::compute(
      [](const Vec3& p) {
        return (p - Vec3::Constant(kSide / 2)).cwiseAbs().maxCoeff() - kSide / 2;
      },
      sampling);
  labels.layers.push_back(
      {kBallRegion,
       DistanceField::compute([](const Vec3& p) { return p.x() - kSide / 2 - kOff; }, sampling)});
  fit_interfaces(mesh, labels);
  const double expected = kSide * kSide * (kSide / 2 + kOff);
  EXPECT_NEAR(region_volumes(mesh, 4)[kBallRegion], expected, 0.002 * expected);
  EXPECT_EQ(compute_quality(mesh).inverted, 0U);
}

TEST(FitInterfaces, LeavesTheCutByTheRegionOfInterestWhereItIs) {
  TetMesh mesh = resolved();
  for (Interface& f : mesh.interfaces)
    if (f.front == kOutside) f.front = kBeyond;
  RegionLabels labels = make_labels();
  labels.region_of_interest = RegionOfInterest{Vec3::Zero(), 1.1 * kBody, std::nullopt};
  const TetMesh before = mesh;
  fit_interfaces(mesh, labels);
  for (const Interface& f : mesh.interfaces) {
    if (f.front != kBeyond) continue;
    for (const std::uint32_t v : f.vertices) ASSERT_EQ(mesh.vertices[v], before.vertices[v]);
  }
}

TEST(FillWithTetgen, KeepsTheInterfacesAndTheVolumesAndShapesTheTetrahedraWell) {
  TetMesh mesh = resolved();
  const TetMesh before = mesh;
  const auto method = fill_with_tetgen(mesh, *find_tet_neighbours(mesh));
  EXPECT_EQ(method, FillMethod::quality);
  ASSERT_EQ(mesh.interfaces.size(), before.interfaces.size());
  for (const Interface& f : mesh.interfaces)
    for (const std::uint32_t v : f.vertices) ASSERT_EQ(mesh.vertices[v], before.vertices[v]);
  const auto volumes = region_volumes(mesh, 4);
  const auto expected = region_volumes(before, 4);
  for (const RegionId r : {kFirstRegion, kBallRegion})
    EXPECT_NEAR(volumes[r], expected[r], 1e-9 * expected[r]);
  const TetQuality quality = compute_quality(mesh);
  EXPECT_EQ(quality.inverted, 0U);
  EXPECT_GT(quality.above_8_deg_percent(), 99);
  EXPECT_GT(quality.smallest_deg, compute_quality(before).smallest_deg);
}

TEST(FillWithTetgen, MakesNoTetrahedronLargerThanItsRegionAsks) {
  const auto largest = [](std::span<const RegionSizing> sizing) {
    TetMesh mesh = resolved();
    static_cast<void>(fill_with_tetgen(mesh, *find_tet_neighbours(mesh), sizing));
    std::array<double, 4> volume{};
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      volume[mesh.regions[t]] = std::max(volume[mesh.regions[t]], tet_volume(mesh, t));
    return volume;
  };
  std::vector<RegionSizing> sizing(4);
  sizing[kBallRegion].cell_size = 1.5e-3;
  const double regular = 8 / (9 * std::sqrt(3.0)) * std::pow(1.5e-3, 3);
  const auto free = largest({});
  const auto bounded = largest(sizing);
  EXPECT_GT(free[kBallRegion], 2 * regular);
  EXPECT_LE(bounded[kBallRegion], 1.001 * regular);
  EXPECT_GT(bounded[kFirstRegion], 2 * regular) << "the other region asks for nothing";
}

}  // namespace
}  // namespace artus
