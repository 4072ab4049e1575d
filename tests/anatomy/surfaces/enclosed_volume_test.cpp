// SPDX-License-Identifier: AGPL-3.0-or-later
// Each place that a surface encloses counts once.
#include "artus/anatomy/surfaces/enclosed_volume.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "artus/core/units.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

constexpr double kRadius = 10 * kMillimetre;

SurfaceMesh two_balls(double apart) {
  SurfaceMesh both = make_sphere(Vec3::Zero(), kRadius);
  append_mesh(both, make_sphere(Vec3(apart, 0, 0), kRadius));
  return both;
}

TEST(EnclosedVolume, OfPiecesThatAreApartIsTheirSum) {
  const SurfaceMesh both = two_balls(3 * kRadius);
  EXPECT_DOUBLE_EQ(enclosed_volume(both), signed_volume(both));
}

TEST(EnclosedVolume, OfTwoBallsIsTheirSumLessTheLens) {
  const double ball = signed_volume(make_sphere(Vec3::Zero(), kRadius));
  for (const double apart : {0.2 * kRadius, kRadius, 1.6 * kRadius}) {
    const double lens = std::numbers::pi * (4 * kRadius + apart) * (2 * kRadius - apart) *
                        (2 * kRadius - apart) / 12;
    EXPECT_NEAR(enclosed_volume(two_balls(apart)), 2 * ball - lens, 0.01 * ball) << apart;
  }
}

TEST(EnclosedVolume, OfACopyBesideItselfIsThatOfOne) {
  const double ball = signed_volume(make_sphere(Vec3::Zero(), kRadius));
  EXPECT_NEAR(enclosed_volume(two_balls(1e-6)), ball, 0.002 * ball);
}

TEST(EnclosedVolume, LeavesACavityOut) {
  SurfaceMesh shell = make_sphere(Vec3::Zero(), kRadius);
  SurfaceMesh cavity = make_sphere(Vec3::Zero(), kRadius / 2);
  for (Triangle& t : cavity.triangles) std::swap(t[1], t[2]);
  append_mesh(shell, cavity);
  EXPECT_DOUBLE_EQ(enclosed_volume(shell), signed_volume(shell));
}

}  // namespace
}  // namespace artus
