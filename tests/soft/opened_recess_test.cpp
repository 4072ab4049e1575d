// SPDX-License-Identifier: AGPL-3.0-or-later
// Spaces that are no sheet on a head: thick, round, long, steep, under bone. Each opens by what is
// given.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "artus/detail/soft/liquid/opened_space.h"

namespace artus {
namespace {

constexpr RegionId kMuscle = 2;
constexpr RegionId kRecess = 3;
constexpr RegionId kBone = 4;

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
CompiledJoint make_recess(const Vec3& axes, const Eigen::Quaterniond& turn, double roof = 0) {
  CompiledJoint joint;
  joint.tissues.resize(3);
  joint.tissues[2].haptic.hard = true;
  joint.regions = {{"outside", 0, Vec3::Zero()},
                   {"beyond", 0, Vec3::Zero()},
                   {"muscle", 0, Vec3::Zero()},
                   {"recess", 1, Vec3::Zero()},
                   {"bone", 2, Vec3::Zero()}};
  constexpr int kRings = 24;
  constexpr int kSides = 48;
  const auto p = [&](int ring, int side) {
    const double polar = std::numbers::pi * ring / kRings;
    const double round = 2 * std::numbers::pi * side / kSides;
    return Vec3(turn * axes.cwiseProduct(Vec3(std::sin(polar) * std::cos(round),
                                              std::sin(polar) * std::sin(round), std::cos(polar))));
  };
  for (int r = 0; r < kRings; ++r) {
    for (int s = 0; s < kSides; ++s) {
      if (r > 0) add_wall(joint, {p(r, s), p(r + 1, s), p(r, s + 1)}, kMuscle, kRecess);
      if (r + 1 < kRings)
        add_wall(joint, {p(r, s + 1), p(r + 1, s), p(r + 1, s + 1)}, kMuscle, kRecess);
    }
  }
  add_plane(joint, 30e-3, kOutside, roof > 0 ? kBone : kMuscle);
  if (roof > 0) add_plane(joint, roof, kBone, kMuscle);
  return joint;
}

double held(const CompiledJoint& joint, const std::vector<Vec3>& p) {
  double six = 0;
  for (const Interface& f : joint.mesh.interfaces)
    if (f.back == kRecess)
      six += p[f.vertices[0]].dot(p[f.vertices[1]].cross(p[f.vertices[2]]));
    else if (f.front == kRecess)
      six -= p[f.vertices[0]].dot(p[f.vertices[1]].cross(p[f.vertices[2]]));
  return six / 6;
}

/// Points on rays out of the recess, from its wall on: the least share of a volume that is left
/// anywhere, and the farthest that the way back misses.
struct Followed {
  double least = 1;
  double missed = 0;  // m
};

Followed follow(const OpenedSpace& space, const OpenedSpace::Filling& filling, const Vec3& axes,
                const Eigen::Quaterniond& turn) {
  constexpr double kSmall = 2e-6;  // m
  const OpenedSpace::Flow flow = space.flow(filling);
  const auto to = [&](const Vec3& p) {
    return flow.forth(flow.place_of(p, Vec3::Zero())).p;
  };
  Followed out;
  for (int i = 0; i < 150; ++i) {
    const double z = 1 - (2 * i + 1) / 150.0;
    const double round = 2.39996 * i;
    const double aside = std::sqrt(1 - z * z);
    const Vec3 way(aside * std::cos(round), aside * std::sin(round), z);
    for (const double beyond : {0.3e-3, 1.5e-3, 4e-3}) {
      const Vec3 p = turn * (axes.cwiseProduct(way) + beyond * way);
      Eigen::Matrix3d slope;
      for (int a = 0; a < 3; ++a)
        slope.col(a) =
            (to(p + kSmall * Vec3::Unit(a)) - to(p - kSmall * Vec3::Unit(a))) / (2 * kSmall);
      out.least = std::min(out.least, slope.determinant());
      const auto place = flow.forth(flow.place_of(p, Vec3::Zero()));
      out.missed = std::max(out.missed, (flow.back(place).p - p).norm());
    }
  }
  return out;
}

TEST(OpenedRecess, OpensByItsVolumeAndFoldsNothingWhateverItsShape) {
  for (const Vec3& axes :
       {Vec3(30, 18, 3), Vec3(9, 8, 7), Vec3(25, 12, 1), Vec3(6, 5, 3), Vec3(4, 4, 4)}) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vec3(1, 0.3, 0).normalized()));
    const CompiledJoint joint = make_recess(1e-3 * axes, turn);
    const OpenedSpace space(joint, {kRecess});
    const Vec3 tip = turn * (1e-3 * axes.cwiseProduct(Vec3(-0.5, -0.6, -0.3)));
    for (const double share : {0.02, 0.5, 2.0}) {  // of its own
      const double volume = share * space.rest_volume();
      const OpenedSpace::Filling filling{tip, volume, {}};
      const auto moved = space.vertices(joint.mesh, filling);
      const std::string what =
          ::testing::PrintToString(axes.transpose()) + ", " + std::to_string(share);
      EXPECT_NEAR(held(joint, moved) - held(joint, joint.mesh.vertices), volume, 1e-9 * volume)
          << what;
      const Followed followed = follow(space, filling, 1e-3 * axes, turn);
      EXPECT_GT(followed.least, 0.5) << what;
      EXPECT_LT(followed.missed, 1e-9) << what;
    }
  }
}

TEST(OpenedRecess, OpensInwardWhereBoneLiesOnAllOfIt) {
  const CompiledJoint joint =
      make_recess(Vec3(14e-3, 10e-3, 2e-3), Eigen::Quaterniond::Identity(), 3e-3);
  const OpenedSpace space(joint, {kRecess});
  const auto moved = space.vertices(joint.mesh, {Vec3::Zero(), 1e-6, {}});
  EXPECT_NEAR(held(joint, moved) - held(joint, joint.mesh.vertices), 1e-6, 1e-15);
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kBone) continue;
    for (const std::uint32_t v : f.vertices) EXPECT_EQ(moved[v], joint.mesh.vertices[v]);
  }
}

TEST(OpenedRecess, SaysThatASmallOneIsAllOpen) {
  const auto flat = Eigen::Quaterniond::Identity();
  const CompiledJoint small = make_recess(Vec3(14e-3, 10e-3, 3e-3), flat);
  EXPECT_TRUE(OpenedSpace(small, {kRecess}).confines(Vec3::Zero(), 5e-6));
  const CompiledJoint wide = make_recess(Vec3(50e-3, 50e-3, 2e-3), flat);
  EXPECT_FALSE(OpenedSpace(wide, {kRecess}).confines(Vec3::Zero(), 2e-6));
}

}  // namespace
}  // namespace artus
