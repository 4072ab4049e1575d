// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/beam_walls.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/layered_body.h"

namespace artus {
namespace {

/// 200 beams through a lens 1 + `opening` m thick at its middle, walls 20 mm deep.
BeamWalls lens_walls(double opening) {
  BeamWalls walls(200);
  for (std::size_t i = 50; i < 150; ++i) {
    const double r = (static_cast<double>(i) - 100) / 50;
    const double shape = (1 - r * r) * (1 - r * r);
    walls[i] = {{20e-3 - opening * shape, 20.05e-3}};
  }
  return walls;
}

TEST(BeamWalls, ALensHasNoJump) {
  EXPECT_LT(find_wall_jump(lens_walls(0), lens_walls(6e-3)).jump, 0.3e-3);
}

TEST(BeamWalls, ALedgeIsAJumpWhereItIs) {
  BeamWalls cut = lens_walls(6e-3);
  for (std::size_t i = 120; i < 150; ++i) cut[i] = {{19.9e-3, 20.05e-3}};
  const WallJump jump = find_wall_jump(lens_walls(0), cut);
  EXPECT_GT(jump.jump, 3e-3);
  EXPECT_EQ(jump.beam, 119U);
}

TEST(BeamWalls, ABlockThatEndsSquareIsAJumpOfHalfItsHeight) {
  BeamWalls block(200);
  for (std::size_t i = 60; i < 140; ++i) block[i] = {{10e-3, 20e-3}};
  EXPECT_NEAR(find_wall_jump(lens_walls(0), block).jump, 5e-3, 0.1e-3);
}

TEST(BeamWalls, ARoundWallThatLiesAlongABeamIsNoJump) {
  for (const double off : {0.0, 0.2, 0.5, 0.8}) {
    BeamWalls ball(200);
    for (std::size_t i = 0; i < 200; ++i) {
      const double x = (static_cast<double>(i) - 100 + off) * kBeamSpacing;
      const double square = 100e-6 - x * x;
      if (square > 0) ball[i] = {{20e-3 - std::sqrt(square), 20e-3 + std::sqrt(square)}};
    }
    EXPECT_LT(find_wall_jump(lens_walls(0), ball).jump, 0.5e-3) << off;
  }
}

TEST(BeamWalls, AStripOfOneBeamIsAJump) {
  BeamWalls strips = lens_walls(6e-3);
  for (std::size_t i = 80; i < 120; i += 2) strips[i][0].roof -= 2e-3;
  EXPECT_GT(find_wall_jump(lens_walls(0), strips).jump, 1.5e-3);
}

TEST(BeamWalls, AnIslandOfTissueInLiquidIsAJump) {
  BeamWalls island = lens_walls(6e-3);
  island[100] = {{14e-3, 15e-3}, {18e-3, 20.05e-3}};
  EXPECT_GT(find_wall_jump(lens_walls(0), island).jump, 1e-3);
}

TEST(BeamWalls, AStepOfTheBodyAtRestIsNoJump) {
  const auto stepped = [](double opening) {
    BeamWalls walls(200);
    for (std::size_t i = 0; i < 200; ++i) {
      const double floor = i < 100 ? 20e-3 : 24e-3;
      walls[i] = {{floor - opening - 4.5e-3, floor}};
    }
    return walls;
  };
  EXPECT_NEAR(find_wall_jump(stepped(0), stepped(3e-3)).jump, 0, 1e-12);
}

TEST(BeamWalls, BeamsMeetALayersWallsAtTheirDepths) {
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"muscle", 10e-3}, {"bursa", 3e-3}, {"bone", 8e-3}};
  const Scene scene(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 60e-3, 60e-3)));
  std::vector<bool> regions(scene.joint().regions.size(), false);
  regions[test::region_named(scene.joint(), "bursa")] = true;
  const BeamWalls walls = find_walls(scene, Pose::Identity(), Transducer(), 40e-3, regions);
  ASSERT_EQ(walls.size(), 201U);
  for (const auto& beam : walls) {
    ASSERT_EQ(beam.size(), 1U);
    EXPECT_NEAR(beam[0].roof, 12e-3, 1e-7);
    EXPECT_NEAR(beam[0].floor, 15e-3, 1e-7);
  }
}

}  // namespace
}  // namespace artus
