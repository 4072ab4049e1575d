// SPDX-License-Identifier: AGPL-3.0-or-later
// Spaces that are no sheet on a head: thick, round, long, steep, under bone. Each opens by what is
// given.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "artus/detail/soft/liquid/inflated_space.h"

namespace artus {
namespace {

constexpr RegionId kMuscle = 1;
constexpr RegionId kRecess = 2;
constexpr RegionId kBone = 3;

void add_wall(CompiledJoint& joint, const std::array<Vec3, 3>& corners, RegionId front,
              RegionId back) {
  Interface f;
  for (std::size_t k = 0; k < 3; ++k) {
    f.vertices[k] = static_cast<std::uint32_t>(joint.mesh.vertices.size());
    joint.mesh.vertices.push_back(corners[k]);
  }
  f.front = front;
  f.back = back;
  joint.mesh.interfaces.push_back(f);
}

/// A plane at height z in pieces of 5 mm.
void add_plane(CompiledJoint& joint, double z, RegionId front, RegionId back) {
  constexpr int kN = 12;
  const auto p = [z](int i, int j) {
    return Vec3(5e-3 * i, 5e-3 * j, z);
  };
  for (int j = -kN; j < kN; ++j) {
    for (int i = -kN; i < kN; ++i) {
      add_wall(joint, {p(i, j), p(i + 1, j), p(i + 1, j + 1)}, front, back);
      add_wall(joint, {p(i, j), p(i + 1, j + 1), p(i, j + 1)}, front, back);
    }
  }
}

/// An ellipsoid around the origin in muscle whose skin lies 30 mm above; `roof`: bone from so many
/// m above the origin on, 0: none.
CompiledJoint make_recess(const Vec3& axes, const Eigen::Quaterniond& turn, double roof = 0,
                          int rings = 24) {
  CompiledJoint joint;
  joint.tissues.resize(3);
  joint.tissues[2].haptic.hard = true;
  joint.regions = {{"outside", 0, Vec3::Zero()},
                   {"muscle", 0, Vec3::Zero()},
                   {"recess", 1, Vec3::Zero()},
                   {"bone", 2, Vec3::Zero()}};
  const int sides = 2 * rings;
  const auto p = [&](int ring, int side) {
    const double polar = std::numbers::pi * ring / rings;
    const double round = 2 * std::numbers::pi * side / sides;
    return Vec3(turn * axes.cwiseProduct(Vec3(std::sin(polar) * std::cos(round),
                                              std::sin(polar) * std::sin(round), std::cos(polar))));
  };
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sides; ++s) {
      if (r > 0) add_wall(joint, {p(r, s), p(r + 1, s), p(r, s + 1)}, kMuscle, kRecess);
      if (r + 1 < rings)
        add_wall(joint, {p(r, s + 1), p(r + 1, s), p(r + 1, s + 1)}, kMuscle, kRecess);
    }
  }
  add_plane(joint, 30e-3, kOutside, roof > 0 ? kBone : kMuscle);
  if (roof > 0) add_plane(joint, roof, kBone, kMuscle);
  return joint;
}

struct Opened {
  double given = 0;  // m^3 more between the walls
  double largest = 0;
  double lowest = 0;  // m along z, of the walls' vertices
};

Opened open(const CompiledJoint& joint, const InflatedSpace& space, double volume) {
  const auto moved = space.vertices(volume);
  Opened out;
  out.largest = space.largest_opening(volume);
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.back != kRecess) continue;
    const auto six = [&f](const std::vector<Vec3>& p) {
      return p[f.vertices[0]].dot(p[f.vertices[1]].cross(p[f.vertices[2]]));
    };
    out.given += (six(moved) - six(joint.mesh.vertices)) / 6;
    for (const std::uint32_t v : f.vertices)
      out.lowest = std::min(out.lowest, moved[v].z() - joint.mesh.vertices[v].z());
  }
  return out;
}

TEST(InflatedRecess, OpensTowardTheSkinByItsVolumeWhateverItsShapeAndWhereverTheTip) {
  for (const Vec3& axes : {Vec3(30, 18, 3), Vec3(14, 10, 3), Vec3(30, 5, 4), Vec3(9, 8, 7),
                           Vec3(4, 4, 4), Vec3(25, 12, 1)}) {
    for (const double degrees : {0.0, 45.0, 90.0}) {
      const Eigen::Quaterniond turn(
          Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3(1, 0.3, 0).normalized()));
      const CompiledJoint joint = make_recess(1e-3 * axes, turn, 0, 16);
      for (const Vec3& tip : {Vec3(0, 0, 0), Vec3(-0.5, -0.6, -0.3)}) {
        const InflatedSpace space(joint, kRecess, turn * (1e-3 * axes.cwiseProduct(tip)));
        for (const double volume : {0.1e-6, 1e-6, 5e-6}) {
          if (volume > 10 * space.rest_volume()) continue;  // more than it holds
          const Opened opened = open(joint, space, volume);
          const std::string what = ::testing::PrintToString(axes.transpose()) + ", turned by " +
                                   std::to_string(degrees) + ", " + std::to_string(volume * 1e6);
          EXPECT_NEAR(opened.given, volume, 1e-12) << what;
          EXPECT_GT(opened.largest, 0) << what;
          if (degrees < 60) {
            EXPECT_GT(opened.lowest, -0.2e-3) << what;
          }
        }
      }
    }
  }
}

// A finger's: with a rim as wide as in a shoulder its middle opened five times as far as all of it
// would.
TEST(InflatedRecess, ASmallOneOpensOverMostOfItself) {
  for (const Vec3& axes : {Vec3(6, 5, 3), Vec3(5, 4, 2), Vec3(12, 3, 2)}) {
    const CompiledJoint joint = make_recess(1e-3 * axes, Eigen::Quaterniond::Identity());
    const InflatedSpace space(joint, kRecess, Vec3(0, 0, 0.3e-3 * axes.z()));
    const double volume = 0.2 * space.rest_volume();
    const Opened opened = open(joint, space, volume);
    EXPECT_NEAR(opened.given, volume, 1e-12);
    const double over_all = volume / (1e-6 * std::numbers::pi * axes.x() * axes.y());  // m
    EXPECT_LT(opened.largest, 3.5 * over_all) << axes.transpose();
  }
}

TEST(InflatedRecess, OpensInwardWhereBoneLiesOnAllOfIt) {
  const CompiledJoint joint =
      make_recess(Vec3(14e-3, 10e-3, 2e-3), Eigen::Quaterniond::Identity(), 3e-3);
  const InflatedSpace space(joint, kRecess, Vec3::Zero());
  EXPECT_NEAR(open(joint, space, 1e-6).given, 1e-6, 1e-12);
  const auto moved = space.vertices(1e-6);
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kBone) continue;
    for (const std::uint32_t v : f.vertices) EXPECT_EQ(moved[v], joint.mesh.vertices[v]);
  }
}

TEST(InflatedRecess, SaysThatASmallOneIsAllOpen) {
  const auto flat = Eigen::Quaterniond::Identity();
  const CompiledJoint small = make_recess(Vec3(14e-3, 10e-3, 3e-3), flat);
  EXPECT_TRUE(InflatedSpace(small, kRecess, Vec3::Zero()).confines(5e-6));
  const CompiledJoint wide = make_recess(Vec3(50e-3, 50e-3, 2e-3), flat);
  EXPECT_FALSE(InflatedSpace(wide, kRecess, Vec3::Zero()).confines(5e-6));
}

}  // namespace
}  // namespace artus
