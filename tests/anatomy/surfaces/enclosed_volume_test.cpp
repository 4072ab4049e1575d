// SPDX-License-Identifier: AGPL-3.0-or-later
// Each place that a surface encloses counts once.
#include "artus/detail/anatomy/surfaces/enclosed_volume.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

constexpr double kBall = 10 * kMillimetre;

SurfaceMesh two_balls(double apart) {
  SurfaceMesh both = make_sphere(Vec3::Zero(), kBall);
  append_mesh(both, make_sphere(Vec3(apart, 0, 0), kBall));
  return both;
}

TEST(EnclosedVolume, OfPiecesThatAreApartIsTheirSum) {
  const SurfaceMesh both = two_balls(3 * kBall);
  EXPECT_DOUBLE_EQ(enclosed_volume(both), signed_volume(both));
}

TEST(EnclosedVolume, OfTwoBallsIsTheirSumLessTheLens) {
  const double ball = signed_volume(make_sphere(Vec3::Zero(), kBall));
  for (const double apart : {0.2 * kBall, kBall, 1.6 * kBall}) {
    const double lens =
        std::numbers::pi * (4 * kBall + apart) * (2 * kBall - apart) * (2 * kBall - apart) / 12;
    EXPECT_NEAR(enclosed_volume(two_balls(apart)), 2 * ball - lens, 0.01 * ball) << apart;
  }
}

TEST(EnclosedVolume, OfACopyBesideItselfIsThatOfOne) {
  const double ball = signed_volume(make_sphere(Vec3::Zero(), kBall));
  EXPECT_NEAR(enclosed_volume(two_balls(1e-6)), ball, 0.002 * ball);
}

TEST(EnclosedVolume, LeavesACavityOut) {
  SurfaceMesh shell = make_sphere(Vec3::Zero(), kBall);
  SurfaceMesh cavity = make_sphere(Vec3::Zero(), kBall / 2);
  for (Triangle& t : cavity.triangles) std::swap(t[1], t[2]);
  append_mesh(shell, cavity);
  EXPECT_DOUBLE_EQ(enclosed_volume(shell), signed_volume(shell));
}

}  // namespace
}  // namespace artus
