// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/layer_map.h"

#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/soft/solver/deformed_body.h"
#include "artus/detail/soft/solver/rest_path.h"
#include "artus/detail/soft/solver/soft_block.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

SoftMaterial film() {
  SoftMaterial m = linear_material(600, 0.47);
  m.bulk = 50e3;
  m.drain_pressure = 2e3;
  return m;
}

SoftMaterial bone() {
  SoftMaterial m;
  m.hard = true;
  return m;
}

struct Layered {
  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const BodyMap> map;

  [[nodiscard]] std::shared_ptr<const DeformedBody> moved(
      const std::function<Vec3(const Vec3&)>& u) const {
    std::vector<Vec3> nodes;
    const Cage& cage = map->model->cage();
    for (const Vec3& p : cage.nodes()) nodes.push_back(u(p));
    for (std::uint32_t n = 0; n < nodes.size(); ++n) {
      if (!cage.masters(n).empty()) nodes[n].setZero();
      for (const NodeShare& share : cage.masters(n))
        nodes[n] += share.weight * u(cage.nodes()[share.node]);
    }
    return std::make_shared<const DeformedBody>(joint, map, nodes, ContactForce{});
  }
};

/// Muscle, 1.5 mm of `thin` from 13.5 mm on, muscle; the cube of 6 mm that holds it begins at 12.
Layered block_with(const SoftMaterial& thin, double cell = 6e-3, std::vector<CageZone> zones = {}) {
  const SoftMaterial muscle = linear_material(10e3, 0.47);
  SoftBlock block;
  block.half_x = block.half_y = 48e-3;
  block.layers = {{13.5e-3, muscle}, {1.5e-3, thin}, {33e-3, muscle}};
  const std::array<test::FlatLayer, 3> layers{
      {{"muscle", 13.5e-3}, {"bursa", 1.5e-3}, {"muscle", 33e-3}}};
  Layered made;
  made.joint =
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 96e-3, 96e-3));
  made.map =
      make_body_map(*made.joint, Pose::Identity(), make_block_model(block, cell, std::move(zones)));
  return made;
}

/// Squeezes what lies between 12 and 18 mm by `way`, m.
std::function<Vec3(const Vec3&)> squeezed(double distance) {
  return [distance](const Vec3& p) {
    return Vec3(0, 0, distance * std::clamp((18e-3 - p.z()) / 6e-3, 0.0, 1.0));
  };
}

double thickness(const DeformedBody& body, double from, double to, double x = 1e-3) {
  const auto at = [&](double z) {
    return z + body.displacement({x, 2e-3, z}).z();
  };
  return at(to) - at(from);
}

TEST(DeformedBody, MovesWhatLiquidLiftedOffTheBodyAsTheSkinBelow) {
  const Layered block = block_with(film());
  const auto body =
      block.moved([](const Vec3& p) { return Vec3(0.1 * p.x(), 0, 0.5 * (48e-3 - p.z())); });
  const Vec3 skin = body->motion(Vec3(4e-3, 2e-3, -1e-3)).displacement;
  EXPECT_GT(skin.z(), 20e-3);
  for (const double up : {3e-3, 9e-3, 25e-3}) {
    const DeformedBody::Motion lifted = body->motion(Vec3(4e-3, 2e-3, -up));
    EXPECT_LT((lifted.displacement - skin).norm(), 1e-9) << up;
    EXPECT_LT((lifted.gradient.col(2) - Vec3::UnitZ()).norm(), 1e-9) << up;
    const Vec3 now = Vec3(4e-3, 2e-3, -up) + lifted.displacement;
    EXPECT_LT((body->to_rest(now, Vec3::Zero()).p_rest - Vec3(4e-3, 2e-3, -up)).norm(), 1e-6) << up;
  }
}

TEST(LayerMap, FluidThatDrainsTakesTheStrainByItsCompliance) {
  const Layered block = block_with(film());
  const double solid =
      1 / (linear_material(10e3, 0.47).bulk + 2 * linear_material(10e3, 0.47).shear);
  const double fluid = 1 / film().drain_pressure;
  for (const double distance : {0.1e-3, 1.2e-3}) {
    const auto body = block.moved(squeezed(distance));
    const double share = 1.5 * fluid / (1.5 * fluid + 4.5 * solid);
    EXPECT_NEAR(thickness(*body, 13.5e-3, 15e-3), 1.5e-3 - share * distance, 2e-6);
    EXPECT_NEAR(thickness(*body, 12e-3, 18e-3), 6e-3 - distance, 1e-9);  // the cube's faces stay
    EXPECT_NEAR(thickness(*body, 12e-3, 13.5e-3), 1.5e-3 - (1 - share) * distance / 3, 2e-6);
  }
}

TEST(LayerMap, FluidClosesToATenthAndTheOthersTakeTheRest) {
  const auto body = block_with(film()).moved(squeezed(2e-3));
  EXPECT_NEAR(thickness(*body, 13.5e-3, 15e-3), 0.15e-3, 2e-6);
  EXPECT_NEAR(thickness(*body, 15e-3, 18e-3), 3e-3 - 0.65e-3 * 3 / 4.5, 2e-6);
}

TEST(LayerMap, BoneKeepsItsLength) {
  const auto body = block_with(bone()).moved(squeezed(1e-3));
  EXPECT_NEAR(thickness(*body, 13.5e-3, 15e-3), 1.5e-3, 2e-6);
  EXPECT_NEAR(thickness(*body, 12e-3, 18e-3), 5e-3, 1e-9);
}

TEST(LayerMap, StiffLayerIsThinnedByItsOwnStretchSideways) {
  // Nothing is stretched above 12 mm, from 18 mm on all is, and volumes are kept in the mean.
  const Layered block = block_with(linear_material(1e6, 0.47));
  const double stretch = 0.2;
  const auto sideways = [&](double z) {
    return stretch * std::clamp((z - 12e-3) / 6e-3, 0.0, 1.0);
  };
  const auto body = block.moved([&](const Vec3& p) {
    return Vec3(sideways(p.z()) * p.x(), 0, squeezed(6e-3 * (1 - 1 / 1.1))(p).z());
  });
  const auto even = block_with(linear_material(10e3, 0.47)).moved([&](const Vec3& p) {
    return Vec3(sideways(p.z()) * p.x(), 0, squeezed(6e-3 * (1 - 1 / 1.1))(p).z());
  });
  const double own = 1 / (1 + stretch * 2.25 / 6);  // by the stretch at its middle
  EXPECT_NEAR(thickness(*even, 13.5e-3, 15e-3, 1e-4) / 1.5e-3, 1 / 1.1, 1e-9);
  EXPECT_NEAR(thickness(*body, 13.5e-3, 15e-3, 1e-4) / 1.5e-3, own, 6e-3);
}

/// A press that varies along x and y, with strains up to 25 % in the cubes with the film.
std::shared_ptr<const DeformedBody> uneven(const Layered& block) {
  return block.moved([](const Vec3& p) {
    const double fades = std::exp(-p.squaredNorm() / 4e-4);
    return Vec3(0.2e-3 * std::sin(150 * p.x()) * fades, 0.1e-3 * fades, 2.5e-3 * fades);
  });
}

std::vector<Vec3> points(std::size_t n) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < n; ++i) {
    const auto noise = [&](std::uint64_t k) {
      return uniform_noise(k, i);
    };
    all.emplace_back(30e-3 * (noise(1) - 0.5), 30e-3 * (noise(2) - 0.5), 12e-3 + 6e-3 * noise(3));
  }
  return all;
}

TEST(LayerMap, InverseFindsTheMaterialPoint) {
  for (const SoftMaterial& thin : {film(), bone(), linear_material(1e6, 0.47)}) {
    const auto body = uneven(block_with(thin));
    for (const Vec3& X : points(500)) {
      const auto back = body->to_rest(X + body->displacement(X));
      ASSERT_TRUE(back.found);
      ASSERT_LT((back.p_rest - X).norm(), 2e-6);
    }
  }
}

TEST(LayerMap, GradientIsThatOfTheDisplacement) {
  const auto body = uneven(block_with(film()));
  std::size_t bent = 0;
  for (const Vec3& X : points(300)) {
    constexpr double kStep = 1e-7;
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    for (int k = 0; k < 3; ++k) {
      Vec3 d = Vec3::Zero();
      d[k] = kStep;
      F.col(k) += (body->displacement(X + d) - body->displacement(X - d)) / (2 * kStep);
    }
    bent += (F - body->motion(X).gradient).norm() > 1e-3 ? 1 : 0;  // on a border of the samples
  }
  EXPECT_LT(bent, 3U);
}

TEST(LayerMap, LeavesNoGapsBetweenCubes) {
  const CageZone middle{Vec3(-12e-3, -12e-3, 0), Vec3(12e-3, 12e-3, 24e-3), 3e-3};
  for (const auto& block :
       {block_with(film()), block_with(film(), 6e-3, {middle}),
        block_with(film(), 12e-3, {{Vec3(-12e-3, -12e-3, 0), Vec3(12e-3, 12e-3, 24e-3), 6e-3}})}) {
    const auto body = uneven(block);
    for (const Vec3& p : points(300)) {
      for (int k = 0; k < 3; ++k) {
        Vec3 X = p;
        X[k] = 3e-3 * std::round(X[k] / 3e-3);
        Vec3 d = Vec3::Zero();
        d[k] = 1e-9;
        ASSERT_LT((body->displacement(X + d) - body->displacement(X - d)).norm(), 2e-8) << X;
      }
    }
  }
}

TEST(LayerMap, LineIsStraightBetweenItsKnotsToTenMicrometres) {
  const auto body = uneven(block_with(film()));
  for (const double x : {-8e-3, 0.3e-3, 5e-3}) {
    const Vec3 origin(x, 0.7e-3, 4e-3);
    const Vec3 direction = Vec3(0.05, 0.02, 1).normalized();
    const RestPath distance(*body, origin, direction);
    RestKnot left = distance.at(0);
    int n = 0;
    for (; left.along < 20e-3; ++n) {
      const RestKnot right = distance.next(left);
      for (const double share : {0.25, 0.5, 0.75, 1.0}) {
        const double along = left.along + share * (right.along - left.along);
        const Vec3 straight = left.rest_J + share * (right.rest_J - left.rest_J);
        // In the body as it lies: within the film a step of it is ten of its material.
        const Vec3 there = straight + body->displacement(straight);
        EXPECT_LT((there - origin - along * direction).norm(), 10e-6) << along;
      }
      left = right;
    }
    EXPECT_LT(n, 60);
  }
}

TEST(LayerMap, AtRestOrOfOneTissueNothingIsMoved) {
  const Layered block = block_with(film());
  const auto rest = block.moved([](const Vec3&) { return Vec3(Vec3::Zero()); });
  for (const Vec3& X : points(50)) EXPECT_EQ(rest->displacement(X), Vec3::Zero());
  const auto cut = [](const Layered& some) {
    const auto columns = some.map->model->layers().columns();
    return std::count_if(columns.begin(), columns.end(),
                         [](const LayerMap::Column& c) { return c.cut(); });
  };
  EXPECT_EQ(cut(block), 65 * 65);  // 96 mm in cubes of 6 mm, a line every 1.5 mm
  EXPECT_EQ(cut(block_with(linear_material(10e3, 0.47))), 0);
}

}  // namespace
}  // namespace artus
