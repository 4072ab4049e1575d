// SPDX-License-Identifier: AGPL-3.0-or-later
// Surfaces that an export has cropped, and the advice that a refusal gives: following it works.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/repair.h"
#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_distance.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kMm = 1e-3;

const RepairAction* find_action(const RepairOutcome& outcome, RepairKind kind) {
  for (const auto& a : outcome.actions)
    if (a.kind == kind) return &a;
  return nullptr;
}

void expect_closed_without_crossings(const RepairOutcome& outcome) {
  const auto edges = count_edges(outcome.mesh);
  EXPECT_EQ(edges.open, 0U);
  EXPECT_EQ(edges.non_manifold, 0U);
  EXPECT_TRUE(find_self_intersections(outcome.mesh).empty());
}

/// A prism of length `length` along z over an outline, open at both ends or closed by a fan at the
/// bottom. The outline runs counter-clockwise.
SurfaceMesh make_prism(const std::vector<Vec3>& outline, double length, std::uint32_t rings) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t r = 0; r < rings; ++r)
    for (const Vec3& p : outline) mesh.vertices.push_back(p + Vec3(0, 0, length * r / (rings - 1)));
  for (std::uint32_t r = 0; r + 1 < rings; ++r)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = r * n + k;
      const std::uint32_t b = r * n + (k + 1) % n;
      mesh.triangles.push_back({a, b, b + n});
      mesh.triangles.push_back({a, b + n, a + n});
    }
  return mesh;
}

/// A muscle's cross-section that lies around a bone: a C of inner and outer radius, so that it is
/// neither round nor seen from its middle.
std::vector<Vec3> make_c(double inner, double outer, int n) {
  std::vector<Vec3> outline;
  for (int k = 0; k <= n; ++k) {
    const double a = 0.3 + (2 * std::numbers::pi - 0.6) * k / n;
    outline.emplace_back(outer * std::cos(a), outer * std::sin(a), 0);
  }
  for (int k = n; k >= 0; --k) {
    const double a = 0.3 + (2 * std::numbers::pi - 0.6) * k / n;
    outline.emplace_back(inner * std::cos(a), inner * std::sin(a), 0);
  }
  return outline;
}

double area_of_c(const std::vector<Vec3>& outline) {
  double twice = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec3& a = outline[k];
    const Vec3& b = outline[(k + 1) % outline.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2;
}

TEST(FlatCut, OfAMuscleAroundABoneIsCappedAlongItsOutline) {
  const auto outline = make_c(12 * kMm, 20 * kMm, 400);
  const auto out = repair_surface(make_prism(outline, 60 * kMm, 40));
  ASSERT_TRUE(out) << out.error().to_string();
  ASSERT_NE(find_action(*out, RepairKind::capped_ends), nullptr);
  EXPECT_EQ(find_action(*out, RepairKind::capped_ends)->count, 2U);
  const double area = area_of_c(outline);
  EXPECT_NEAR(find_action(*out, RepairKind::capped_ends)->amount, 2 * area, 1e-3 * area);
  EXPECT_NEAR(out->volume, area * 60 * kMm, 1e-3 * area * 60 * kMm);
  expect_closed_without_crossings(*out);
}

TEST(FlatCut, ThroughAThinMuscleIsNotSewnLikeACrack) {
  const auto outline = make_c(19.6 * kMm, 20 * kMm, 300);  // 0.4 mm: as near as a crack's lips
  const double area = area_of_c(outline);
  const auto thin = make_prism(outline, 30 * kMm, 60);
  const auto out = repair_surface(thin, {.crack_width = 0.3 * kMm});
  ASSERT_TRUE(out) << out.error().to_string();
  EXPECT_NEAR(out->volume, area * 30 * kMm, 0.01 * area * 30 * kMm);
}

class SliceOfAMuscle : public testing::TestWithParam<double> {};

// Two parallel cuts a few millimetres apart: each cap is larger than what is left of the muscle.
TEST_P(SliceOfAMuscle, IsCappedWhateverItsShare) {
  const double length = GetParam();
  const auto out = repair_surface(make_tube(48, 3, 20 * kMm, length));
  ASSERT_TRUE(out) << out.error().to_string();
  const double area = 24 * std::sin(2 * std::numbers::pi / 48) * 20 * kMm * 20 * kMm;
  EXPECT_NEAR(out->volume, area * length, 1e-3 * area * length);
  expect_closed_without_crossings(*out);
}
INSTANTIATE_TEST_SUITE_P(Lengths, SliceOfAMuscle, testing::Values(3e-3, 8e-3, 20e-3));

/// The part of a ball beyond a plane at `height` from its middle; the cut follows the triangles'
/// edges when `jagged`, else the vertices next to the plane are moved onto it.
SurfaceMesh make_cut_ball(double radius, double height, bool jagged) {
  const SurfaceMesh ball = make_sphere(Vec3::Zero(), radius);
  const Vec3 normal = Vec3(1, 0.2, 0.35).normalized();  // not along rows or columns
  std::vector<bool> keep;
  for (const Triangle& t : ball.triangles)
    keep.push_back(normal.dot(triangle_centre(ball, t)) > height);
  SurfaceMesh mesh = keep_faces(ball, keep);
  if (jagged) return mesh;
  for (const auto& rim : find_rims(mesh, make_edge_uses(mesh)))
    for (const auto v : rim) mesh.vertices[v] += (height - normal.dot(mesh.vertices[v])) * normal;
  return mesh;
}

double cap_volume(double radius, double height) {
  const double h = radius - height;
  return std::numbers::pi * h * h * (3 * radius - h) / 3;
}

class CutBall : public testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(CutBall, IsClosedByItsPlaneWithoutCrossings) {
  const auto [height, jagged] = GetParam();
  const auto mesh = make_cut_ball(50 * kMm, height, jagged);
  const auto out = repair_surface(mesh);
  ASSERT_TRUE(out) << out.error().to_string();
  const double volume = cap_volume(50 * kMm, height);
  EXPECT_NEAR(out->volume, volume, 0.03 * volume);
  expect_closed_without_crossings(*out);
  EXPECT_EQ(find_action(*out, RepairKind::wrapped), nullptr);
}
// From a muscle that lacks its end to a body cut mid-sagittally (half its surface).
INSTANTIATE_TEST_SUITE_P(Planes, CutBall,
                         testing::Combine(testing::Values(-40e-3, -20e-3, 0.0, 15e-3),
                                          testing::Values(false)));
INSTANTIATE_TEST_SUITE_P(Teeth, CutBall,
                         testing::Combine(testing::Values(-40e-3, -20e-3, -10e-3, 0.0, 10e-3),
                                          testing::Values(true)));

TEST(FlatCut, AcrossAHollowIsCappedAsARing) {
  SurfaceMesh pipe = make_tube(60, 20, 20 * kMm, 50 * kMm);
  SurfaceMesh hollow = make_tube(60, 20, 12 * kMm, 50 * kMm);
  for (Triangle& t : hollow.triangles) std::swap(t[0], t[1]);
  append_mesh(pipe, hollow);
  // One piece: joined by a disc's ring at the bottom, cut at the top.
  const auto n = static_cast<std::uint32_t>(60 * 20);
  for (std::uint32_t k = 0; k < 60; ++k) {
    const std::uint32_t a = k;
    const std::uint32_t b = (k + 1) % 60;
    pipe.triangles.push_back({b, a, a + n});
    pipe.triangles.push_back({b, a + n, b + n});
  }
  const auto out = repair_surface(pipe);
  ASSERT_TRUE(out) << out.error().to_string();
  const double ring = 30 * std::sin(2 * std::numbers::pi / 60) * (400 - 144) * kMm * kMm;
  EXPECT_NEAR(out->volume, ring * 50 * kMm, 1e-3 * ring * 50 * kMm);
  expect_closed_without_crossings(*out);
}

/// Three quarters of a ball: what is left where a wedge was taken out of it. Its one opening is as
/// far from flat as can be.
SurfaceMesh make_bitten_ball(double radius) {
  const SurfaceMesh ball = make_sphere(Vec3::Zero(), radius);
  std::vector<bool> keep;
  for (const Triangle& t : ball.triangles) {
    const Vec3 c = triangle_centre(ball, t);
    keep.push_back(c.x() < 0.1 * radius || std::abs(c.y()) > 0.8 * radius || c.z() < 0);
  }
  return keep_faces(ball, keep);
}

SurfaceMesh make_open_box() {
  SurfaceMesh box = make_cube(Vec3::Zero(), 20 * kMm);
  box.triangles.erase(box.triangles.begin() + 2, box.triangles.begin() + 6);  // top and front
  return box;
}

TEST(Advice, WrapIsOfferedForWhatEnclosesAVolumeAndWorks) {
  const auto mesh = make_open_box();
  const auto refused = repair_surface(mesh, {.largest_fill_share = 0.3});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("too large to be closed safely"));
  EXPECT_THAT(refused.error().message, Not(HasSubstr("thicken")));
  EXPECT_THAT(refused.error().message, HasSubstr("--skip-refused"));
  ASSERT_THAT(refused.error().message, HasSubstr("repair = \"wrap\""));
  const auto out = repair_surface(mesh, {.largest_fill_share = 0.3, .wrap = WrapPolicy::always});
  ASSERT_TRUE(out) << out.error().to_string();
  ASSERT_NE(find_action(*out, RepairKind::wrapped), nullptr);
  EXPECT_GT(out->volume, 0.4 * 64e-6) << "a body, not a hollow plate";
  EXPECT_LT(out->volume, 1.02 * 64e-6);
  expect_closed_without_crossings(*out);
}

TEST(Advice, TeethOfARimMakeNoSheetOfABody) {
  const SurfaceMesh ball = make_sphere(Vec3::Zero(), 50 * kMm);
  std::vector<bool> keep;
  for (const Triangle& t : ball.triangles) {
    const Vec3 c = triangle_centre(ball, t);
    const int sector =
        static_cast<int>(std::floor(std::atan2(c.y(), c.x()) * 16 / std::numbers::pi));
    keep.push_back(c.z() < (sector % 2 == 0 ? 25 * kMm : -25 * kMm));
  }
  const auto refused = repair_surface(keep_faces(ball, keep));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("too large to be closed safely"));
  EXPECT_THAT(refused.error().message, Not(HasSubstr("thicken")));
  EXPECT_THAT(refused.error().message, HasSubstr("repair = \"wrap\""));
}

TEST(Advice, ThickeningIsOfferedForSheetsAloneAndWorks) {
  SurfaceMesh sheet;
  sheet.vertices = {Vec3::Zero(), Vec3(0.02, 0, 0), Vec3(0, 0.03, 0), Vec3(0.02, 0.03, 0)};
  sheet.triangles = {{0, 1, 2}, {1, 3, 2}};
  const auto refused = repair_surface(sheet);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("thicken = 1.0"));
  EXPECT_THAT(refused.error().message, HasSubstr("--skip-refused"));
  const auto plate = repair_surface(sheet, {.thicken = 1 * kMm});
  ASSERT_TRUE(plate) << plate.error().to_string();
  EXPECT_NEAR(plate->volume, 0.02 * 0.03 * 1 * kMm, 1e-9);
}

TEST(Wrap, SaysBothWaysHowFarItIsAndHowItsVolumeChanged) {
  const auto ball = make_bitten_ball(30 * kMm);
  const auto out = repair_surface(ball, {.wrap = WrapPolicy::always});
  ASSERT_TRUE(out) << out.error().to_string();
  const auto* wrapped = find_action(*out, RepairKind::wrapped);
  ASSERT_NE(wrapped, nullptr);
  EXPECT_THAT(wrapped->message, HasSubstr("in the mean"));
  EXPECT_THAT(wrapped->message, HasSubstr("95 % within"));
  EXPECT_THAT(wrapped->message, HasSubstr("both ways"));
  EXPECT_THAT(wrapped->message, HasSubstr("%)"));
  // The ball's own surface is no farther from the wrap than that says.
  const DistanceTree tree(out->mesh);
  for (const Triangle& t : ball.triangles)
    EXPECT_LE(tree.distance(triangle_centre(ball, t), 1), wrapped->amount + 1e-5);
}

/// A ball with a jagged hole whose teeth are bent inward, so that a smooth patch crosses them.
SurfaceMesh make_ball_with_teeth(double radius, double depth) {
  SurfaceMesh mesh = make_cut_ball(radius, -0.8 * radius, true);
  const auto rims = find_rims(mesh, make_edge_uses(mesh));
  const Vec3 normal = Vec3(1, 0.2, 0.35).normalized();
  for (std::size_t k = 0; k < rims[0].size(); k += 2) mesh.vertices[rims[0][k]] += depth * normal;
  return mesh;
}

TEST(HoleFilling, AddsNoCrossingsAndKeepsTheVolumeWhereTheRimIsTorn) {
  for (const double depth : {1 * kMm, 3 * kMm, 6 * kMm}) {
    SCOPED_TRACE(depth);
    const auto mesh = make_ball_with_teeth(40 * kMm, depth);
    const std::size_t before = find_self_intersections(mesh).size();
    const auto out = repair_surface(mesh, {.remove_self_intersections = false});
    if (!out) {
      EXPECT_THAT(out.error().message, HasSubstr("->"));
      continue;
    }
    EXPECT_LE(out->self_intersections, before + 10);
    EXPECT_NEAR(out->volume, out->volume_before, 0.1 * out->volume_before);
  }
}

}  // namespace
}  // namespace artus
