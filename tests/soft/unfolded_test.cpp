// SPDX-License-Identifier: AGPL-3.0-or-later
// A block of tetrahedra with liquid in its middle, some of them turned over by hand.
#include "artus/detail/soft/liquid/unfolded.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr int kSide = 8;        // cubes along each edge
constexpr double kEdge = 1e-3;  // m of a cube
constexpr RegionId kTissue = kFirstRegion;
constexpr RegionId kLiquid = kFirstRegion + 1;

std::uint32_t at(int x, int y, int z) {
  return static_cast<std::uint32_t>((z * (kSide + 1) + y) * (kSide + 1) + x);
}

bool is_liquid(int x, int y, int z) {
  const auto middle = [](int c) {
    return c == kSide / 2 || c == kSide / 2 - 1;
  };
  return middle(x) && middle(y) && middle(z);
}

/// Six tetrahedra around a diagonal in each cube.
TetMesh make_block() {
  TetMesh mesh;
  for (int z = 0; z <= kSide; ++z)
    for (int y = 0; y <= kSide; ++y)
      for (int x = 0; x <= kSide; ++x) mesh.vertices.emplace_back(kEdge * Vec3(x, y, z));
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int z = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        for (const auto& order : kOrders) {
          std::array<int, 3> p{x, y, z};
          std::array<std::uint32_t, 4> tet{at(x, y, z)};
          for (std::size_t k = 0; k < 3; ++k) {
            ++p[static_cast<std::size_t>(order[k])];
            tet[k + 1] = at(p[0], p[1], p[2]);
          }
          mesh.tetrahedra.push_back(tet);
          mesh.regions.push_back(is_liquid(x, y, z) ? kLiquid : kTissue);
          if (tet_volume(mesh, mesh.tetrahedra.size() - 1) < 0)
            std::swap(mesh.tetrahedra.back()[2], mesh.tetrahedra.back()[3]);
        }
  return mesh;
}

/// Faces between liquid and tissue, normals out of the liquid.
std::vector<WallTriangle> walls_of(const TetMesh& mesh) {
  std::map<WallTriangle, std::pair<WallTriangle, int>> faces;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.regions[t] != kLiquid) continue;
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    for (const WallTriangle& face : {WallTriangle{a, c, b}, {a, b, d}, {a, d, c}, {b, c, d}}) {
      WallTriangle key = face;
      std::sort(key.begin(), key.end());
      auto& known = faces[key];
      known.first = face;
      ++known.second;
    }
  }
  std::vector<WallTriangle> walls;
  for (const auto& [key, face] : faces)
    if (face.second == 1) walls.push_back(face.first);
  return walls;
}

Unfolding unfolding_of(const TetMesh& mesh) {
  Unfolding unfolding;
  unfolding.held.assign(mesh.vertices.size(), false);
  unfolding.loose.assign(kLiquid + 1, false);
  unfolding.loose[kLiquid] = true;
  unfolding.walls = walls_of(mesh);
  unfolding.finer = unfolding.walls;
  return unfolding;
}

double volume_in(const std::vector<WallTriangle>& walls, const std::vector<Vec3>& p) {
  double six = 0;
  for (const auto& [a, b, c] : walls) six += p[a].dot(p[b].cross(p[c]));
  return six / 6;
}

/// Of tissue, against `rest`.
double least_ratio(const TetMesh& rest, const std::vector<Vec3>& moved) {
  TetMesh now = rest;
  now.vertices = moved;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < rest.tetrahedra.size(); ++t)
    if (rest.regions[t] == kTissue)
      least = std::min(least, tet_volume(now, t) / tet_volume(rest, t));
  return least;
}

class Unfolded : public ::testing::Test {
 protected:
  TetMesh mesh_ = make_block();
  Unfolding unfolding_ = unfolding_of(mesh_);
  std::vector<Vec3> moved_ = mesh_.vertices;
};

TEST_F(Unfolded, HasWallsAroundTheLiquid) {
  EXPECT_EQ(unfolding_.walls.size(), 48U);
  EXPECT_NEAR(volume_in(unfolding_.walls, mesh_.vertices), 8 * std::pow(kEdge, 3), 1e-20);
}

TEST_F(Unfolded, LeavesWhatIsRight) {
  for (Vec3& p : moved_) p *= 1.3;
  const std::vector<Vec3> before = moved_;
  EXPECT_TRUE(unfold(mesh_, unfolding_, moved_));
  EXPECT_EQ(moved_, before);
}

TEST_F(Unfolded, TurnsTissueBackAndKeepsTheLiquid) {
  // A wall pushed through the tissue above it, and tissue that was pulled into the liquid beside.
  moved_[at(4, 4, 5)].z() += 2.2 * kEdge;
  moved_[at(5, 4, 4)].x() += 0.6 * kEdge;
  moved_[at(6, 4, 4)].x() -= 1.2 * kEdge;
  const double volume = volume_in(unfolding_.walls, moved_);
  ASSERT_LT(least_ratio(mesh_, moved_), 0);
  EXPECT_TRUE(unfold(mesh_, unfolding_, moved_));
  EXPECT_GT(least_ratio(mesh_, moved_), 0.05);
  EXPECT_NEAR(volume_in(unfolding_.walls, moved_), volume, 1e-9 * volume);
  double all = 0;  // tissue keeps its volume nearly
  TetMesh now = mesh_;
  now.vertices = moved_;
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
    if (mesh_.regions[t] == kTissue) all += tet_volume(now, t) - tet_volume(mesh_, t);
  EXPECT_LT(std::abs(all), 0.15 * volume);
}

TEST_F(Unfolded, MovesNothingThatIsHeldOrFarAway) {
  moved_[at(2, 2, 2)] += 1.5 * kEdge * Vec3(1, 1, 1);
  unfolding_.held[at(3, 2, 2)] = true;
  const std::vector<Vec3> before = moved_;
  EXPECT_TRUE(unfold(mesh_, unfolding_, moved_));
  EXPECT_GT(least_ratio(mesh_, moved_), 0.05);
  EXPECT_EQ(moved_[at(3, 2, 2)], before[at(3, 2, 2)]);
  EXPECT_EQ(moved_[at(kSide, kSide, kSide)], before[at(kSide, kSide, kSide)]);
  EXPECT_NE(moved_[at(2, 2, 2)], before[at(2, 2, 2)]);
}

TEST_F(Unfolded, Untwists) {
  // Half a turn of some tissue.
  const Eigen::AngleAxisd turn(std::numbers::pi, Vec3::UnitZ());
  const Vec3 centre = kEdge * Vec3(2, 2, 2);
  for (int z = 1; z <= 3; ++z)
    for (int y = 1; y <= 3; ++y)
      for (int x = 1; x <= 3; ++x) {
        Vec3& p = moved_[at(x, y, z)];
        if (x + y + z < 9) p = centre + turn * (p - centre);
      }
  ASSERT_LT(least_ratio(mesh_, moved_), 0);
  EXPECT_TRUE(unfold(mesh_, unfolding_, moved_));
  EXPECT_GT(least_ratio(mesh_, moved_), 0.05);
}

TEST_F(Unfolded, LeavesWhatCannotBePutRight) {
  moved_[at(4, 4, 5)].z() += 2.2 * kEdge;
  unfolding_.held.assign(moved_.size(), true);
  const std::vector<Vec3> before = moved_;
  EXPECT_FALSE(unfold(mesh_, unfolding_, moved_));
  EXPECT_EQ(moved_, before);
}

TEST_F(Unfolded, TakesAlongWhatWasCutFiner) {
  // The middle of an edge that nothing but a finer wall has, beside what is put right.
  const auto middle = static_cast<std::uint32_t>(moved_.size());
  const Vec3 half = (mesh_.vertices[at(4, 4, 5)] + mesh_.vertices[at(5, 4, 5)]) / 2;
  mesh_.vertices.push_back(half);
  moved_[at(4, 4, 5)].z() += 2.2 * kEdge;
  moved_.push_back((moved_[at(4, 4, 5)] + moved_[at(5, 4, 5)]) / 2);
  unfolding_.held.push_back(false);
  EXPECT_TRUE(unfold(mesh_, unfolding_, moved_));
  const Vec3 now = (moved_[at(4, 4, 5)] + moved_[at(5, 4, 5)]) / 2;
  EXPECT_LT((moved_[middle] - now).norm(), 0.02 * kEdge);
}

}  // namespace
}  // namespace artus
