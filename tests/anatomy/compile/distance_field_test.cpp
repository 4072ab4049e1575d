// SPDX-License-Identifier: AGPL-3.0-or-later
// The sampled signed distance of a ball and of a cube against their closed forms.
#include "artus/detail/anatomy/compile/labels/distance_field.h"

#include <cmath>
#include <numbers>

#include <oneapi/tbb/global_control.h>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

constexpr double kRadius = 0.02;     // m
constexpr double kSpacing = 0.5e-3;  // m
constexpr double kBand = 3e-3;       // m

const FieldSampling kSampling{{Vec3::Constant(-0.03), Vec3::Constant(0.03)}, kSpacing, kBand};

double ball(const Vec3& p) {
  return p.norm() - kRadius;
}

Vec3 random_point(std::uint64_t i, double half) {
  return half * (2 * Vec3(uniform_noise(3, 3 * i), uniform_noise(3, 3 * i + 1),
                          uniform_noise(3, 3 * i + 2)) -
                 Vec3::Ones());
}

TEST(DistanceField, OfABallIsItsDistanceNearTheSurfaceAndTellsTheSideEverywhere) {
  const DistanceField field = DistanceField::compute(ball, kSampling);
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Vec3 p = random_point(i, 0.029);
    ASSERT_LE(std::abs(field.value(p)), kBand * (1 + 1e-6));
    if (std::abs(ball(p)) > kSpacing) {
      ASSERT_GT(field.value(p) * ball(p), 0);
    } else {
      ASSERT_NEAR(field.value(p), ball(p), 0.01e-3) << "trilinear in a function of curvature 2 / r";
    }
  }
}

TEST(DistanceField, OfASurfaceIsTheDistanceToItsTriangles) {
  const DistanceTree tree(make_cube(Vec3::Zero(), 0.02));
  const DistanceField field = DistanceField::compute(tree, kSampling);
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Vec3 p = random_point(i, 0.029);
    const Vec3 q = p.cwiseAbs() - Vec3::Constant(0.02);
    const double exact = q.cwiseMax(Vec3::Zero()).norm() + std::min(q.maxCoeff(), 0.0);
    if (std::abs(exact) > kBand - 2 * kSpacing) {
      EXPECT_GT(field.value(p) * exact, 0) << "the right side";
    } else {
      EXPECT_NEAR(field.value(p), exact, 0.5 * kSpacing) << "rounded at edges only";
    }
  }
}

TEST(DistanceField, OutsideItsBoxEverythingIsOutside) {
  const DistanceField field = DistanceField::compute(ball, kSampling);
  EXPECT_EQ(field.value(Vec3(0.05, 0, 0)), kBand);
  EXPECT_EQ(DistanceField().value(Vec3::Zero()), 0) << "and an empty field knows nothing";
}

TEST(DistanceField, ItsNormalPointsAwayFromTheBall) {
  const DistanceField field = DistanceField::compute(ball, kSampling);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Vec3 direction = random_point(i, 1).normalized();
    EXPECT_NEAR((field.normal(kRadius * direction) - direction).norm(), 0, 0.02);
  }
}

TEST(DistanceField, TheStorageTellsTheSideOnlyWhereItIsSure) {
  const DistanceField field = DistanceField::compute(ball, kSampling);
  const auto around = [](const Vec3& p, double half) {
    return Box{p - Vec3::Constant(half), p + Vec3::Constant(half)};
  };
  EXPECT_EQ(field.side_of(around(Vec3::Zero(), 1e-3)), -1);
  EXPECT_EQ(field.side_of(around(Vec3::Constant(0.028), 0.5e-3)), 1);
  EXPECT_EQ(field.side_of(around(Vec3(kRadius, 0, 0), 1e-3)), 0);
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Box box = around(random_point(i, 0.028), 1e-3);
    const int side = field.side_of(box);
    if (side == 0) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p((corner & 1) != 0 ? box.upper.x() : box.lower.x(),
                   (corner & 2) != 0 ? box.upper.y() : box.lower.y(),
                   (corner & 4) != 0 ? box.upper.z() : box.lower.z());
      EXPECT_GT(side * ball(p), 0);
    }
  }
}

TEST(DistanceField, IntegratesTheVolumeAndTheMomentOfABall) {
  const DistanceField field = DistanceField::compute(ball, kSampling);
  const double volume = 4.0 / 3 * std::numbers::pi * std::pow(kRadius, 3);
  EXPECT_NEAR(field.integrate([](const Vec3&) { return 1.0; }), volume, 2e-3 * volume);
  const double moment = volume * kRadius * kRadius / 5;  // of z^2
  EXPECT_NEAR(field.integrate([](const Vec3& p) { return p.z() * p.z(); }), moment, 5e-3 * moment);
}

TEST(DistanceField, ExtendedItKnowsDistancesFarFromTheSurface) {
  const DistanceTree tree(make_cube(Vec3::Zero(), 0.02));
  DistanceField field = DistanceField::compute(tree, kSampling);
  const Vec3 far(0, 0, 8e-3);
  EXPECT_NEAR(field.value(far), -kBand, 1e-6);
  FieldSampling wider = kSampling;
  wider.spacing = 2e-3;
  wider.band = 15e-3;
  field.extend(tree, wider);
  EXPECT_NEAR(field.value(far), -12e-3, 0.2e-3);
  EXPECT_NEAR(field.value(Vec3(0, 0, 0.02)), 0, 0.05e-3) << "near the surface as before";
}

// What lies far from a part of the box that is known from afar must not seem near.
TEST(DistanceField, BeyondWhereItIsExtendedAPointCountsAsFar) {
  const DistanceTree tree(make_cube(Vec3::Zero(), 0.02));
  DistanceField field = DistanceField::compute(tree, kSampling);
  FieldSampling wider = kSampling;
  wider.box = {Vec3(0, 0, 0.01), Vec3(0.01, 0.01, 0.04)};
  wider.spacing = 2e-3;
  wider.band = 15e-3;
  field.extend(tree, wider);
  EXPECT_DOUBLE_EQ(field.value(Vec3(-0.04, 0, 0)), wider.band);
  EXPECT_DOUBLE_EQ(field.value(Vec3(-0.005, -0.005, 0)), -wider.band) << "inside stays inside";
  EXPECT_NEAR(field.value(Vec3(-0.02, 0, 0)), 0, 0.05e-3) << "near the surface as before";
  field.forget_far();
  EXPECT_NEAR(field.value(Vec3(-0.04, 0, 0)), kBand, 1e-6);
}

TEST(DistanceField, IsTheSameAtAnyNumberOfThreadsAndStoresLittle) {
  const auto sample = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const DistanceField field =
        DistanceField::compute(DistanceTree(make_cube(Vec3::Zero(), 0.02)), kSampling);
    EXPECT_LT(field.memory(), 120U * 120 * 120 * sizeof(float)) << "less than the whole grid";
    std::vector<double> values;
    for (std::uint64_t i = 0; i < 1000; ++i) values.push_back(field.value(random_point(i, 0.03)));
    values.push_back(field.integrate([](const Vec3&) { return 1.0; }));
    return values;
  };
  EXPECT_EQ(sample(1), sample(2));
}

}  // namespace
}  // namespace artus
