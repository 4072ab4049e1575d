// SPDX-License-Identifier: AGPL-3.0-or-later
// Where liquid opens tissue beside bone and walls, on bodies of a few curved sheets; what is found
// is found by lines straight down, from the triangles alone.
#include "artus/soft/bolus.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/soft/cleft.h"
#include "artus/soft/injected_body.h"
#include "artus/soft/parted_sheet.h"

namespace artus {
namespace {

constexpr RegionId kFlesh = 2;
constexpr RegionId kBand = 3;
constexpr RegionId kUnder = 4;
constexpr RegionId kPool = 5;  // the first that is added

using Height = std::function<double(double, double)>;

/// A sheet of height `z` over 100 mm x 80 mm, or a part of it, in pieces of 2 mm; `front` above it.
void add_sheet(CompiledJoint& joint, const Height& z, RegionId front, RegionId back) {
  constexpr int kX = 25;
  constexpr int kY = 20;
  constexpr double kPiece = 2e-3;
  const auto first = static_cast<std::uint32_t>(joint.mesh.vertices.size());
  const auto at = [&](int i, int j) {
    return first + static_cast<std::uint32_t>((j + kY) * (2 * kX + 1) + i + kX);
  };
  for (int j = -kY; j <= kY; ++j)
    for (int i = -kX; i <= kX; ++i)
      joint.mesh.vertices.emplace_back(kPiece * i, kPiece * j, z(kPiece * i, kPiece * j));
  for (int j = -kY; j < kY; ++j)
    for (int i = -kX; i < kX; ++i)
      for (const auto& t : {std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1)},
                            {at(i, j), at(i + 1, j + 1), at(i, j + 1)}}) {
        Interface f;
        f.vertices = t;
        f.front = front;
        f.back = back;
        joint.mesh.interfaces.push_back(f);
      }
}

/// Skin 25 mm above the origin, muscle, a tendon between `roof` and `floor` with its fibres along
/// x, bone.
CompiledJoint make_band(const Height& roof, const Height& floor) {
  CompiledJoint joint;
  joint.tissues.resize(3);
  joint.tissues[0].name = "muscle";
  joint.tissues[0].acoustic.kind = TissueKind::muscle;
  joint.tissues[1].name = "tendon";
  joint.tissues[1].acoustic.kind = TissueKind::tendon;
  joint.tissues[2].name = "bone";
  joint.tissues[2].haptic.hard = true;
  joint.regions = {{"outside", 0, Vec3::Zero()},
                   {"beyond", 0, Vec3::Zero()},
                   {"muscle", 0, Vec3::UnitX()},
                   {"tendon", 1, Vec3::UnitX()},
                   {"bone", 2, Vec3::Zero()}};
  add_sheet(
      joint, [](double, double) { return 25e-3; }, kOutside, kFlesh);
  add_sheet(joint, roof, kFlesh, kBand);
  add_sheet(joint, floor, kBand, kUnder);
  return joint;
}

/// A plate of bone in the muscle over x > `from`, 8 to 10 mm above the origin.
void add_acromion(CompiledJoint& joint, double from) {
  const auto first = static_cast<std::uint32_t>(joint.mesh.vertices.size());
  for (const double z : {8e-3, 10e-3})
    for (const double y : {-15e-3, 15e-3})
      for (const double x : {from, 45e-3}) joint.mesh.vertices.emplace_back(x, y, z);
  for (const auto& [a, b, c, d] : {std::array{0, 1, 3, 2},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 3, 7, 6},
                                   {0, 2, 6, 4},
                                   {1, 3, 7, 5}})
    for (const auto& t : {std::array{a, b, c}, {a, c, d}}) {
      Interface f;
      for (std::size_t k = 0; k < 3; ++k) f.vertices[k] = first + static_cast<std::uint32_t>(t[k]);
      const auto& p = joint.mesh.vertices;
      const Vec3 middle = (p[f.vertices[0]] + p[f.vertices[1]] + p[f.vertices[2]]) / 3;
      const Vec3 out = middle - Vec3((from + 45e-3) / 2, 0, 9e-3);
      const Vec3 normal =
          (p[f.vertices[1]] - p[f.vertices[0]]).cross(p[f.vertices[2]] - p[f.vertices[0]]);
      if (normal.dot(out) < 0) std::swap(f.vertices[1], f.vertices[2]);
      f.front = kFlesh;
      f.back = kUnder;
      joint.mesh.interfaces.push_back(f);
    }
}

/// What lines straight down meet, half a millimetre apart.
struct Beams {
  int n = 0;
  int disordered = 0;  // that enter a region out of another than the one they are in
  double volume = 0;   // m^3 of liquid
};

Beams look_down(const CompiledJoint& joint) {
  constexpr double kApart = 0.5e-3;
  constexpr int kX = 90;
  constexpr int kY = 70;
  struct Hit {
    double z;
    RegionId above;
    RegionId below;
  };
  std::vector<std::vector<Hit>> hits(static_cast<std::size_t>((2 * kX + 1) * (2 * kY + 1)));
  const Vec3 off(0.013e-3, 0.029e-3, 0);  // no line meets an edge
  for (const Interface& f : joint.mesh.interfaces) {
    const Vec3 a = joint.mesh.vertices[f.vertices[0]] - off;
    const Vec3 b = joint.mesh.vertices[f.vertices[1]] - off;
    const Vec3 c = joint.mesh.vertices[f.vertices[2]] - off;
    const Vec3 low = a.cwiseMin(b).cwiseMin(c) / kApart;
    const Vec3 high = a.cwiseMax(b).cwiseMax(c) / kApart;
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const double det = ab.x() * ac.y() - ab.y() * ac.x();
    if (det == 0) continue;
    for (int j = std::max(-kY, static_cast<int>(std::ceil(low.y())));
         j <= std::min<double>(kY, high.y()); ++j)
      for (int i = std::max(-kX, static_cast<int>(std::ceil(low.x())));
           i <= std::min<double>(kX, high.x()); ++i) {
        const Vec3 p = Vec3(kApart * i, kApart * j, 0) - a;
        const double u = (p.x() * ac.y() - p.y() * ac.x()) / det;
        const double v = (ab.x() * p.y() - ab.y() * p.x()) / det;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const bool front_above = det > 0;
        hits[static_cast<std::size_t>((j + kY) * (2 * kX + 1) + i + kX)].push_back(
            {a.z() + u * ab.z() + v * ac.z(), front_above ? f.front : f.back,
             front_above ? f.back : f.front});
      }
  }
  Beams beams;
  for (auto& line : hits) {
    std::sort(line.begin(), line.end(), [](const Hit& x, const Hit& y) { return x.z > y.z; });
    RegionId in = kOutside;
    bool ordered = true;
    for (std::size_t k = 0; k < line.size(); ++k) {
      // Two walls within 10 nm are one.
      ordered = ordered && (line[k].above == in || (k > 0 && line[k - 1].z - line[k].z < 1e-8));
      in = line[k].below;
      if (in == kPool && k + 1 < line.size())
        beams.volume += (line[k].z - line[k + 1].z) * kApart * kApart;
    }
    ++beams.n;
    beams.disordered += ordered ? 0 : 1;
  }
  return beams;
}

double most_moved_bone(const CompiledJoint& before, const CompiledJoint& after) {
  double most = 0;
  for (const Interface& f : before.mesh.interfaces)
    if (before.tissue_of(f.front).haptic.hard || before.tissue_of(f.back).haptic.hard)
      for (const std::uint32_t v : f.vertices)
        most = std::max(most, (after.mesh.vertices[v] - before.mesh.vertices[v]).norm());
  return most;
}

/// A head of 25 mm radius under a tendon that thins from 6 mm to 1 mm toward +x.
double head(double x, double y) {
  return std::sqrt(std::max(36e-6, 625e-6 - x * x - y * y)) - 25e-3;
}
double tapering(double x, double y) {
  const double share = std::clamp((x + 20e-3) / 40e-3, 0.0, 1.0);
  return head(x, y) + 6e-3 - 5e-3 * share;
}

TEST(Bolus, OfATendonOnBoneMovesNoBoneAndPassesNoWall) {
  const double level = 2e-3;
  struct Case {
    std::string name;
    CompiledJoint joint;
    Vec3 tip;
  };
  std::vector<Case> cases{
      {"flat", make_band([](double, double) { return 5e-3; }, [](double, double) { return 0.0; }),
       Vec3(0, 0, level)},
      {"on a head", make_band([](double x, double y) { return head(x, y) + 5e-3; }, head),
       Vec3(0, 0, level)},
      {"tapering", make_band(tapering, head), Vec3(8e-3, 0, head(8e-3, 0) + 1.2e-3)}};
  cases.push_back(cases[1]);
  cases.back().name = "under an acromion";
  add_acromion(cases.back().joint, 5e-3);
  for (const Case& c : cases) {
    ASSERT_EQ(look_down(c.joint).disordered, 0) << c.name;
    for (const double volume : {0.1e-6, 0.5e-6, 1e-6}) {
      const auto boluses = make_boluses(c.joint, kBand, c.tip, volume);
      double sum = 0;
      for (const Bolus& bolus : boluses) sum += bolus.volume;
      EXPECT_NEAR(sum, volume, 1e-15);
      const CompiledJoint with = with_boluses(c.joint, boluses, Liquid{});
      const Beams beams = look_down(with);
      const std::string what = c.name + ", " + std::to_string(volume * 1e6) + " ml";
      EXPECT_EQ(most_moved_bone(c.joint, with), 0) << what;
      EXPECT_NEAR(beams.volume, volume, 0.01 * volume) << what;
      EXPECT_LE(beams.disordered, beams.n / 2000) << what;
    }
  }
}

TEST(Bolus, OpensAwayFromBoneAndAsFarEitherWayWhereThereIsNone) {
  CompiledJoint joint =
      make_band([](double, double) { return 12e-3; }, [](double, double) { return 0.0; });
  const Vec3 tip(0, 0, 6e-3);
  for (const Bolus& bolus : make_boluses(joint, kBand, tip, 0.2e-6)) EXPECT_EQ(bolus.up, 1);
  joint.tissues[2].haptic.hard = false;
  EXPECT_EQ(make_boluses(joint, kBand, tip, 0.2e-6).back().up, 0.5);
  joint.tissues[2].haptic.hard = true;
  const std::vector<Vec3> bone = find_bone_points(joint, tip);
  ASSERT_GT(bone.size(), 1000U);
  const Cleft cleft(make_boluses(joint, kBand, tip, 0.2e-6).back(), bone);
  EXPECT_EQ(cleft.free_share(true), 1);
  EXPECT_LT(cleft.free_share(false), 0.01);
  EXPECT_EQ(cleft.moved(Vec3(0, 0, 1e-3)), Vec3(0, 0, 1e-3)) << "below, toward the bone";
  EXPECT_GT(cleft.moved(Vec3(0, 0, 11e-3)).z(), 11.5e-3);
}

TEST(Bolus, ACleftPassesItsVolumeThroughEveryLevelAndKeepsTheOrderOfWhatLiesAboveIt) {
  Bolus bolus;
  bolus.proportion = Vec3(12, 8, 0.6);
  bolus.volume = 0.5e-6;
  bolus.up = 1;
  const Cleft cleft(bolus, {});
  for (const double z : {0.1e-3, 3e-3, 15e-3, 40e-3}) {
    double passed = 0;
    constexpr double kStep = 0.25e-3;
    for (double x = -60e-3; x < 60e-3; x += kStep)
      for (double y = -60e-3; y < 60e-3; y += kStep)
        passed += (cleft.moved(Vec3(x, y, z)).z() - z) * kStep * kStep;
    EXPECT_NEAR(passed, bolus.volume, 0.01 * bolus.volume) << z;
  }
  for (const double x : {0.0, 6e-3, 14e-3, 16e-3}) {
    double before = -1;
    for (double z = 0; z < 40e-3; z += 0.1e-3) {
      const double now = cleft.moved(Vec3(x, 0, z)).z();
      EXPECT_GT(now, before);
      before = now;
    }
  }
}

TEST(Bolus, StreaksFollowTheFibresWhereTheyAreKnown) {
  const CompiledJoint joint =
      make_band([](double, double) { return 0.0; }, [](double, double) { return -5e-3; });
  const Vec3 tip(0, 0, 12e-3);
  // Circles around an axis along y, 60 mm away, that come in at 20 degrees.
  const double aslant = 20 * std::numbers::pi / 180;
  const Vec3 centre = tip + 60e-3 * Vec3(std::sin(aslant), 0, -std::cos(aslant));
  const FibreField fibres = [&](RegionId, const Vec3& p) {
    Vec3 from = p - centre;
    from.y() = 0;
    return Vec3(from.cross(Vec3::UnitY()).normalized());
  };
  const auto boluses = make_boluses(joint, kFlesh, tip, 0.6e-6, fibres);
  EXPECT_GT(boluses.size(), 3U);
  double worst_known = 0;
  double worst_axis = 0;
  for (const bool known : {true, false})
    for (const Bolus& bolus :
         make_boluses(joint, kFlesh, tip, 0.6e-6, known ? fibres : FibreField{}))
      for (const double x : {-6e-3, 0.0, 6e-3}) {
        const Eigen::Vector2d p(x, 0);
        const Eigen::Vector2d slope = bolus.slope + bolus.bend * p;
        const double z = bolus.slope.dot(p) + p.dot(bolus.bend * p) / 2;
        const Vec3 at = bolus.centre + bolus.axes * Vec3(x, 0, z);
        const Vec3 along = (bolus.axes * Vec3(1, 0, slope.x())).normalized();
        double& worst = known ? worst_known : worst_axis;
        worst = std::max(worst, std::acos(std::min(1.0, std::abs(along.dot(fibres(0, at))))));
      }
  EXPECT_LT(worst_known * 180 / std::numbers::pi, 4);
  EXPECT_GT(worst_axis * 180 / std::numbers::pi, 15);
}

TEST(PartedSheet, FollowsTheWallsAndEndsBeforeThem) {
  const CompiledJoint joint = make_band([](double x, double y) { return head(x, y) + 5e-3; }, head);
  const Vec3 tip(0, 0, 2.5e-3);
  const FibreField none;
  const PartedSheet sheet(joint, kBand, tip, Eigen::Matrix3d::Identity(), none);
  for (const double x : {-8e-3, 4e-3, 10e-3}) {
    EXPECT_NEAR(sheet.height({x, 0}), head(x, 0), 0.4e-3);
    EXPECT_TRUE(sheet.allows({x, 0}, 0));
    EXPECT_FALSE(sheet.allows({x, 0}, 3e-3));
    EXPECT_FALSE(sheet.allows({x, 0}, -3e-3));
  }
  EXPECT_EQ(sheet.height({0, 0}), 0);
  EXPECT_NEAR(sheet.nearest_level(1), 2.2e-3, 1e-9);
  EXPECT_EQ(sheet.along({3e-3, 1e-3}, 0), Eigen::Vector2d::UnitX());
}

}  // namespace
}  // namespace artus
