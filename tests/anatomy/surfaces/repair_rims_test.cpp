// SPDX-License-Identifier: AGPL-3.0-or-later
// Openings of known shape: what is measured of them, and flat caps with and without a hole.
#include "artus/detail/anatomy/surfaces/repair_rims.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kRadius = 0.01;  // m
constexpr int kCorners = 64;

// Adds a circle's corners to the mesh, in turn or against it.
Rim add_circle(SurfaceMesh& mesh, const Vec3& centre, double radius, bool reversed = false) {
  Rim rim;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * (reversed ? kCorners - i : i) / kCorners;
    rim.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back(centre + radius * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  return rim;
}

double polygon_area(double radius) {
  return 0.5 * kCorners * radius * radius * std::sin(2 * std::numbers::pi / kCorners);
}

double area_of(const SurfaceMesh& mesh, const std::vector<Triangle>& triangles) {
  double area = 0;
  for (const Triangle& t : triangles) {
    const Vec3 a = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    const Vec3 b = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    area += a.cross(b).norm() / 2;
  }
  return area;
}

TEST(MeasureRim, OfACircleGivesItsMeasures) {
  SurfaceMesh mesh;
  const Vec3 centre(0.1, -0.2, 0.3);
  const RimShape shape = measure_rim(mesh, add_circle(mesh, centre, kRadius));
  EXPECT_LT((shape.centre - centre).norm(), 1e-9);
  EXPECT_NEAR(std::abs(shape.normal.z()), 1, 1e-9);
  EXPECT_NEAR(shape.area, polygon_area(kRadius), 1e-12);
  EXPECT_NEAR(shape.perimeter, 2 * kCorners * kRadius * std::sin(std::numbers::pi / kCorners),
              1e-12);
  EXPECT_NEAR(shape.radius, kRadius, 1e-9);
  EXPECT_TRUE(shape.is_planar());
  EXPECT_GT(shape.roundness(), 0.99);
}

TEST(MeasureRim, ToldThatItsCornersLeaveThePlane) {
  SurfaceMesh mesh;
  const Rim rim = add_circle(mesh, Vec3::Zero(), kRadius);
  for (std::size_t i = 0; i < rim.size(); i += 2) mesh.vertices[rim[i]].z() += 0.3 * kRadius;
  EXPECT_FALSE(measure_rim(mesh, rim).is_planar());
}

TEST(IsHoleIn, OnlyWhatLiesInsideTheCutAndRunsTheOtherWay) {
  SurfaceMesh mesh;
  const Rim outer = add_circle(mesh, Vec3::Zero(), kRadius);
  const auto is_hole = [&](const Rim& inner) {
    return is_hole_in(mesh, inner, measure_rim(mesh, inner), outer, measure_rim(mesh, outer));
  };
  EXPECT_TRUE(is_hole(add_circle(mesh, Vec3(0.001, 0, 0), kRadius / 3, true)));
  EXPECT_FALSE(is_hole(add_circle(mesh, Vec3(0.001, 0, 0), kRadius / 3, false)));
  EXPECT_FALSE(is_hole(add_circle(mesh, Vec3(0.03, 0, 0), kRadius / 3, true)));
  EXPECT_FALSE(is_hole(add_circle(mesh, Vec3(0, 0, 0.01), kRadius / 3, true)));
}

TEST(TriangulateFlat, CoversTheCutAndLeavesItsHoleOpen) {
  SurfaceMesh mesh;
  const Rim outer = add_circle(mesh, Vec3::Zero(), kRadius);
  const Rim inner = add_circle(mesh, Vec3(0.002, 0, 0), kRadius / 3, true);
  const auto whole = triangulate_flat(mesh, {}, {outer}, Vec3::UnitZ());
  EXPECT_NEAR(area_of(mesh, whole), polygon_area(kRadius), 1e-12);
  const auto with_hole = triangulate_flat(mesh, {}, {outer, inner}, Vec3::UnitZ());
  EXPECT_NEAR(area_of(mesh, with_hole), polygon_area(kRadius) - polygon_area(kRadius / 3), 1e-12);
}

TEST(TriangulateFlat, GivesNothingAndChangesNothingWhereRimsCross) {
  SurfaceMesh mesh;
  const Rim outer = add_circle(mesh, Vec3::Zero(), kRadius);
  const Rim across = add_circle(mesh, Vec3(kRadius, 0, 0), kRadius / 2, true);
  const std::size_t before = mesh.vertices.size();
  EXPECT_TRUE(triangulate_flat(mesh, {}, {outer, across}, Vec3::UnitZ()).empty());
  EXPECT_EQ(mesh.vertices.size(), before);
}

}  // namespace
}  // namespace artus
