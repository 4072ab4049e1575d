// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/injected_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/soft/liquid/opened_space.h"

namespace artus {
namespace {

constexpr RegionId kAbove = 2;
constexpr RegionId kCleft = 3;
constexpr RegionId kBelow = 4;

/// Flat walls 1 mm apart, 120 mm wide, as grids of 2 mm; skin 20 mm above. `twice`: the same 3 mm
/// higher, as where a bursa lies over itself. `rim`: m from the middle where the walls meet; there
/// is tissue beyond.
CompiledJoint make_cleft(bool twice = false, double rim = 1) {
  CompiledJoint joint;
  joint.tissues.resize(2);
  joint.tissues[0].name = "muscle";
  joint.tissues[0].acoustic.kind = TissueKind::muscle;
  joint.tissues[1].name = "bursa";
  joint.regions = {{"outside", 0, Vec3::Zero()},
                   {"beyond", 0, Vec3::Zero()},
                   {"above", 0, Vec3::UnitX()},
                   {"cleft", 1, Vec3::Zero()},
                   {"below", 0, Vec3::Zero()}};
  constexpr int kN = 60;
  const auto add = [&](double z, RegionId front, RegionId back) {
    const auto first = static_cast<std::uint32_t>(joint.mesh.vertices.size());
    for (int j = 0; j <= kN; ++j)
      for (int i = 0; i <= kN; ++i)
        joint.mesh.vertices.emplace_back(2e-3 * (i - kN / 2), 2e-3 * (j - kN / 2), z);
    const auto beyond = [&](std::uint32_t v) {
      return joint.mesh.vertices[v].head<2>().norm() > rim;
    };
    const bool roof = back == kCleft;
    for (std::size_t v = first; roof && v < joint.mesh.vertices.size(); ++v)
      if (beyond(static_cast<std::uint32_t>(v))) joint.mesh.vertices[v].z() -= 1e-3;
    for (std::uint32_t j = 0; j < kN; ++j) {
      for (std::uint32_t i = 0; i < kN; ++i) {
        const std::uint32_t a = first + j * (kN + 1) + i;
        for (const auto& t : {std::array{a, a + 1, a + kN + 2}, {a, a + kN + 2, a + kN + 1}}) {
          const bool closed = beyond(t[0]) && beyond(t[1]) && beyond(t[2]);
          if (closed && roof) continue;
          Interface f;
          f.vertices = t;
          for (std::uint32_t& v : f.vertices)  // where the walls meet they are one
            if (roof && beyond(v)) v += (kN + 1) * (kN + 1);
          f.front = closed && front == kCleft ? kAbove : front;
          f.back = back;
          joint.mesh.interfaces.push_back(f);
        }
      }
    }
  };
  add(20e-3, kOutside, kAbove);  // normals along +z
  add(1e-3, kAbove, kCleft);
  add(0, kCleft, kBelow);
  if (twice) {
    add(4e-3, kAbove, kCleft);
    add(3e-3, kCleft, kAbove);
  }
  return joint;
}

/// A rectangle of two triangles from middle - u - v to middle + u + v.
void add_wall(CompiledJoint& joint, const Vec3& middle, const Vec3& u, const Vec3& v,
              RegionId front, RegionId back) {
  const auto first = static_cast<std::uint32_t>(joint.mesh.vertices.size());
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    joint.mesh.vertices.push_back(middle + a * u + b * v);
  for (const auto& t : {std::array{0U, 1U, 2U}, std::array{0U, 2U, 3U}}) {
    Interface f;
    f.vertices = {first + t[0], first + t[1], first + t[2]};
    f.front = front;
    f.back = back;
    joint.mesh.interfaces.push_back(f);
  }
}

double flux_between(const CompiledJoint& joint, const std::vector<Vec3>& moved, RegionId front) {
  double volume = 0;
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != front) continue;
    const Vec3 a = joint.mesh.vertices[f.vertices[1]] - joint.mesh.vertices[f.vertices[0]];
    const Vec3 b = joint.mesh.vertices[f.vertices[2]] - joint.mesh.vertices[f.vertices[0]];
    for (const std::uint32_t v : f.vertices)
      volume += (moved[v] - joint.mesh.vertices[v]).dot(a.cross(b)) / 6;
  }
  return volume;
}

/// One lens in the tissue above.
Bolus make_lens() {
  return {kAbove, Vec3(0, 0, 10e-3), Eigen::Matrix3d::Identity(), Vec3(3, 2, 0.6), 1e-6};
}

/// m^3 between the cleft's walls, whose rims do not move.
double enclosed(const CompiledJoint& joint, const std::vector<Vec3>& moved) {
  double volume = 0;
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kCleft && f.back != kCleft) continue;
    const double six = moved[f.vertices[0]].dot(moved[f.vertices[1]].cross(moved[f.vertices[2]]));
    volume += (f.back == kCleft ? six : -six) / 6;
  }
  return volume;
}

constexpr double kRim = 35e-3;  // m

TEST(OpenedSpace, OpensAFlatCleftByItsVolumeAroundTheTip) {
  const CompiledJoint joint = make_cleft(false, kRim);
  const OpenedSpace space(joint, {kCleft});
  const Vec3 tip(0, 0, 0.5e-3);
  const std::size_t n = joint.mesh.vertices.size() / 3;
  for (const double volume : {0.1e-6, 3e-6, 20e-6}) {
    const auto moved = space.vertices(joint.mesh, {tip, volume, {}});
    EXPECT_NEAR(enclosed(joint, moved) - enclosed(joint, joint.mesh.vertices), volume,
                1e-9 * volume);
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_GT(moved[n + i].z(), moved[2 * n + i].z() - 1e-9) << "roof over floor";
    const double opening = space.largest_opening(tip, volume);
    EXPECT_GT(opening, 0.5e-3);
    // All open it is thickest between a crack's profile, 3/2 of the mean, and a clamped plate's, 3.
    const double mean = volume / (std::numbers::pi * kRim * kRim);
    EXPECT_LT(opening, std::max(3 * mean, 6e-3));
    if (volume > 10e-6) {
      EXPECT_GT(opening, 1.5 * mean);
    }
  }
  EXPECT_EQ(space.vertices(joint.mesh, {tip, 0, {}}), joint.mesh.vertices);
}

TEST(OpenedSpace, WhatPressesOnAHalfSendsItsLiquidToTheOther) {
  const CompiledJoint joint = make_cleft(false, kRim);
  const OpenedSpace space(joint, {kCleft});
  const Vec3 tip(0, 0, 0.5e-3);
  const auto free = space.vertices(joint.mesh, {tip, 5e-6, {}});
  const auto pressed = space.vertices(joint.mesh, {tip, 5e-6, [](const Vec3& p) {
                                                     return p.x() < 0 ? 1.0 : 0.0;
                                                   }});
  EXPECT_NEAR(enclosed(joint, pressed) - enclosed(joint, joint.mesh.vertices), 5e-6, 1e-14);
  int compared = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const Vec3& rest = joint.mesh.vertices[i];
    if (rest.z() != 1e-3 || std::abs(rest.x()) < 8e-3 || free[i].z() - rest.z() < 0.2e-3) continue;
    const double share = (pressed[i].z() - rest.z()) / (free[i].z() - rest.z());
    EXPECT_NEAR(share, rest.x() < 0 ? 0.5 : 1.5, 0.15) << rest.transpose();
    ++compared;
  }
  EXPECT_GT(compared, 100);
  // Of what presses everywhere alike nothing comes but a higher pressure.
  const auto alike = space.vertices(joint.mesh, {tip, 5e-6, [](const Vec3&) {
                                                   return 0.7;
                                                 }});
  for (std::size_t i = 0; i < free.size(); ++i) EXPECT_LT((alike[i] - free[i]).norm(), 50e-6);
}

TEST(OpenedSpace, OfASpaceThatLiesOverItselfNoWallPassesAnother) {
  const CompiledJoint joint = make_cleft(true, kRim);
  const auto moved =
      OpenedSpace(joint, {kCleft}).vertices(joint.mesh, {Vec3(0, 0, 0.5e-3), 5e-6, {}});
  const std::size_t n = joint.mesh.vertices.size() / 5;  // of a wall
  for (std::size_t i = 0; i < n; ++i) {
    const double roof = moved[n + i].z();
    EXPECT_GT(roof, moved[2 * n + i].z() - 1e-9);
    EXPECT_GT(moved[4 * n + i].z(), roof) << "the upper sheet's floor over the lower one's roof";
    EXPECT_GT(moved[3 * n + i].z(), moved[4 * n + i].z() - 1e-9);
    EXPECT_GT(moved[i].z(), moved[3 * n + i].z());
  }
}

TEST(OpenedSpace, LiftsTheSkinByItsVolume) {
  const CompiledJoint joint = make_cleft(false, kRim);
  const OpenedSpace space(joint, {kCleft});
  const auto moved = space.vertices(joint.mesh, {Vec3(0, 0, 0.5e-3), 5e-6, {}});
  const double up = flux_between(joint, moved, kOutside);
  EXPECT_GT(up, 0.5 * 5e-6);
  EXPECT_LT(up, 5e-6);
}

TEST(Bolus, HasItsVolumeAndPushesEveryWallBesideItByAsMuch) {
  const CompiledJoint joint = make_cleft();
  Liquid liquid;
  liquid.name = "saline";
  const Bolus bolus = make_lens();
  const CompiledJoint with = with_boluses(joint, {bolus}, liquid);
  EXPECT_EQ(with.regions.back().name, "injected");
  double volume = 0;
  for (const Interface& f : with.mesh.interfaces) {
    if (f.back + 1U != with.regions.size()) continue;
    EXPECT_EQ(f.front, kAbove);
    const auto p = [&](std::size_t k) -> const Vec3& {
      return with.mesh.vertices[f.vertices[k]];
    };
    volume += p(0).dot(p(1).cross(p(2))) / 6;
  }
  EXPECT_NEAR(volume, 1e-6, 1e-15);
  // What was inside the ellipsoid's place is outside of it now.
  for (std::size_t v = 0; v < joint.mesh.vertices.size(); ++v) {
    const Vec3 y = (with.mesh.vertices[v] - bolus.centre).cwiseQuotient(bolus.proportion);
    EXPECT_GE(y.norm() * 1.0, std::cbrt(1e-6 / (4.2 * bolus.proportion.prod())));
  }
  // A plane beside it is passed by the share of the solid angle under which the bolus, drawn to a
  // sphere, sees it, with the film of a tenth that stays around it.
  const std::vector<Vec3> moved(
      with.mesh.vertices.begin(),
      with.mesh.vertices.begin() + static_cast<std::ptrdiff_t>(joint.mesh.vertices.size()));
  const double up = flux_between(joint, moved, kOutside);
  const double down = -flux_between(joint, moved, kAbove);
  const auto share = [](double height) {
    const double a = 60e-3 / 3;
    const double b = 60e-3 / 2;
    const double h = height / 0.6;
    return std::atan(a * b / (h * std::sqrt(a * a + b * b + h * h))) / std::numbers::pi;
  };
  EXPECT_NEAR(up + down, 1.1e-6 * (share(10e-3) + share(9e-3)), 0.02e-6);
}

TEST(Bolus, IsNotCutByAWallOfLargeTriangles) {
  CompiledJoint joint = make_cleft();
  add_wall(joint, 11e-3 * Vec3::UnitZ(), 30e-3 * Vec3::UnitX(), 30e-3 * Vec3::UnitY(), kBelow,
           kAbove);  // across the bolus's upper half
  const Bolus bolus = make_lens();
  const CompiledJoint with = with_boluses(joint, {bolus}, Liquid{});
  const double scale = std::cbrt(1e-6 / (4 * std::numbers::pi / 3 * bolus.proportion.prod()));
  const Eigen::Matrix3d in =
      (scale * bolus.proportion).cwiseInverse().asDiagonal() * bolus.axes.transpose();
  std::size_t pieces = 0;
  for (const Interface& f : with.mesh.interfaces) {
    if (f.front != kBelow || f.back != kAbove) continue;
    ++pieces;
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : f.vertices) middle += with.mesh.vertices[v] / 3;
    EXPECT_GT((in * (middle - bolus.centre)).norm(), 0.95) << "in the liquid";
  }
  EXPECT_GT(pieces, 100U);
}

/// Fat under a skin at z = 20 mm, beside a bone whose wall is steep: it ends at x = 0.
CompiledJoint make_fat_beside_bone() {
  CompiledJoint joint;
  joint.tissues.resize(2);
  joint.tissues[0].name = "fat";
  joint.tissues[0].acoustic.kind = TissueKind::fat;
  joint.tissues[1].name = "bone";
  joint.tissues[1].haptic.hard = true;
  joint.regions = {{"outside", 0, Vec3::Zero()},
                   {"beyond", 0, Vec3::Zero()},
                   {"fat", 0, Vec3::Zero()},
                   {"bone", 1, Vec3::Zero()}};
  const Vec3 x = 40e-3 * Vec3::UnitX();
  const Vec3 y = 40e-3 * Vec3::UnitY();
  const Vec3 z = 40e-3 * Vec3::UnitZ();
  add_wall(joint, 20e-3 * Vec3::UnitZ(), x, y, kOutside, 2);  // normals out of the fat
  add_wall(joint, Vec3::Zero(), z, y, 3, 2);
  add_wall(joint, x, y, z, kOutside, 2);
  return joint;
}

TEST(Bolus, LiesOnTheBoneThatTheTipTouches) {
  const CompiledJoint joint = make_fat_beside_bone();
  const Vec3 tip(0.2e-3, 0, 10e-3);
  const std::vector<Bolus> boluses = make_boluses(joint, 2, tip, 1e-6);
  ASSERT_EQ(boluses.size(), 1U);
  const Bolus& lens = boluses.front();
  EXPECT_GT(std::abs(lens.axes.col(2).x()), 0.99) << "flat along the bone, not along the skin";
  const double half = lens.semi_axes().z();
  EXPECT_NEAR(4 * std::numbers::pi / 3 * lens.semi_axes().prod(), 1e-6, 1e-15);
  EXPECT_NEAR((lens.centre - Vec3(half, 0, 10e-3)).norm(), 0, 1e-6) << "the bone is beside it";
  EXPECT_LT((lens.centre - tip).norm(), half) << "the tip is in it";
  const CompiledJoint with = with_boluses(joint, boluses, Liquid{});
  double farthest = 0;
  double least = 1;
  for (const Interface& f : with.mesh.interfaces)
    if (f.back + 1U == with.regions.size())
      for (const std::uint32_t v : f.vertices) {
        farthest = std::max(farthest, (with.mesh.vertices[v] - lens.centre).norm());
        least = std::min(least, with.mesh.vertices[v].x());
      }
  EXPECT_GT(least, 0) << "in the bone";
  EXPECT_LT(farthest, 1.1 * lens.semi_axes().x()) << "what bone takes of it is not elsewhere";
}

TEST(InjectedBody, LeavesOutWhatCannotBeSeen) {
  const CompiledJoint joint = make_cleft();
  Liquid liquid;
  liquid.name = "saline";
  liquid.backscatter = 0.3;
  const Vec3 tip(0, 0, 0.5e-3);
  const CompiledJoint with = with_injected(
      joint,
      {{"cleft", 2e-6, true, tip}, {"above", 0.9e-9, false, tip}, {"outside", 1e-6, false, tip}},
      liquid);
  EXPECT_EQ(with.regions.size(), joint.regions.size());
  EXPECT_EQ(with.tissue_of(kCleft).name, "injected_saline");
  EXPECT_DOUBLE_EQ(with.tissue_of(kCleft).acoustic.backscatter, 0.3);
}

}  // namespace
}  // namespace artus
