// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/medium/texture.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace artus {
namespace {

struct Kind {
  TissueKind kind = TissueKind::plain;
  Vec3 tile = Vec3::Zero();  // m, its cells times their number, along x, y, z
};
const std::array<Kind, 4> kKinds{{{TissueKind::muscle, {12.8e-3, 19.2e-3, 256e-3}},
                                  {TissueKind::fat, {12.8e-3, 32e-3, 64e-3}},
                                  {TissueKind::tendon, {7.68e-3, 7.68e-3, 96e-3}},
                                  {TissueKind::nerve, {5.12e-3, 5.12e-3, 64e-3}}}};

class TextureTest : public ::testing::TestWithParam<Kind> {
 protected:
  /// A patch of one tile's breadth and depth at `corner`.
  [[nodiscard]] std::vector<float> patch(const Vec3& corner) const {
    const Vec3& tile = GetParam().tile;
    constexpr int kSteps = 200;
    std::vector<float> all;
    std::vector<float> line(kSteps);
    for (int j = 0; j < 60; ++j) {
      const Vec3 from = corner + Vec3(0, tile.y() * j / 60, 0);
      texture_.sample(GetParam().kind, from, Vec3(tile.x() / kSteps, 0, 0), line);
      all.insert(all.end(), line.begin(), line.end());
    }
    return all;
  }
  TissueTexture texture_{3, true};
};

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double ma = 0;
  double mb = 0;
  const auto n = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ma += a[i] / n;
    mb += b[i] / n;
  }
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

/// Tissues that are wider than their tiles: all but nerve.
class WideTextureTest : public TextureTest {};

// A texture that comes again shows as a pattern of rows and columns in a wide muscle.
TEST_P(WideTextureTest, DoesNotComeAgainOneTileDeeperBesideOrAlongTheFibres) {
  const Vec3& tile = GetParam().tile;
  const Vec3 corner(0.3e-3, 0.2e-3, 0.1 * tile.z());
  const std::vector<float> here = patch(corner);
  for (const Vec3& step :
       {Vec3(tile.x(), 0, 0), Vec3(0, tile.y(), 0), Vec3(2 * tile.x(), 0, 0),
        Vec3(tile.x(), tile.y(), 0), Vec3(-tile.x(), tile.y(), 0), Vec3(0, 0, 0.5 * tile.z())})
    EXPECT_LT(correlation(here, patch(corner + step)), 0.25) << step.transpose();
}

// Where the next tile begins there is no edge: steps between neighbours are as large as elsewhere.
TEST_P(TextureTest, GoesOnOverTheBordersOfItsTiles) {
  const Vec3& tile = GetParam().tile;
  const auto step_at = [&](const Vec3& border, const Vec3& across, const Vec3& along) {
    double sum = 0;
    std::vector<float> before(400);
    std::vector<float> after(400);
    texture_.sample(GetParam().kind, border - across, along, before);
    texture_.sample(GetParam().kind, border + across, along, after);
    for (std::size_t i = 0; i < before.size(); ++i) sum += std::pow(after[i] - before[i], 2);
    return sum / static_cast<double>(before.size());
  };
  const Vec3 across_x(0.5 * tile.x() / 128, 0, 0);
  const Vec3 across_y(0, 0.5 * tile.y() / 64, 0);
  const Vec3 along_y(0, 1e-3 * tile.y(), 0);
  const Vec3 along_x(1e-3 * tile.x(), 0, 0);
  double inside = 0;
  double border = 0;
  for (int k = 0; k < 16; ++k) {
    const double z = (k + 0.3) / 16 * tile.z();
    for (const double share : {0.2, 0.4, 0.6, 0.8})
      inside += 0.25 * (step_at({share * tile.x(), 0, z}, across_x, along_y) +
                        step_at({0, share * tile.y(), z}, across_y, along_x));
    border +=
        step_at({tile.x(), 0, z}, across_x, along_y) + step_at({0, tile.y(), z}, across_y, along_x);
  }
  EXPECT_LT(border, 1.5 * inside);
}

TEST_P(TextureTest, HasAMeanSquareOfOne) {
  double sum = 0;
  double n = 0;
  for (int k = 0; k < 64; ++k)
    for (const float factor : patch(Vec3(0, 0, GetParam().tile.z() * (k + 0.5) / 64))) {
      sum += static_cast<double>(factor) * factor;
      ++n;
    }
  EXPECT_NEAR(sum / n, 1, 0.1);
}

std::string name_of_kind(const ::testing::TestParamInfo<Kind>& info) {
  return std::array{"muscle", "fat", "tendon", "nerve"}.at(info.index);
}
INSTANTIATE_TEST_SUITE_P(Kinds, TextureTest, ::testing::ValuesIn(kKinds), name_of_kind);
INSTANTIATE_TEST_SUITE_P(Kinds, WideTextureTest,
                         ::testing::ValuesIn(kKinds.begin(), kKinds.begin() + 3), name_of_kind);

}  // namespace
}  // namespace artus
