// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/penumbra.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kSampleDepth = 40e-3 / 1024;

/// The gain at each sample of line `l` beside a sheet of bone `depth` (m) deep under lines 0 to
/// 127.
std::vector<float> gains_beside_bone(int l, double depth) {
  std::vector<float> shadow_from(256, 1024.0F);
  for (std::size_t i = 0; i < 128; ++i) shadow_from[i] = static_cast<float>(depth / kSampleDepth);
  std::vector<float> re(1024, 1.0F);
  std::vector<float> im(1024, 0.0F);
  add_penumbra(Transducer{}, kSampleDepth, shadow_from, l, {re, im});
  return re;
}

TEST(Penumbra, HalfOfTheApertureSeesTheEdge) {
  const std::vector<float> gain = gains_beside_bone(128, 10e-3);
  EXPECT_FLOAT_EQ(gain[200], 1);       // above the bone
  EXPECT_NEAR(gain[768], 0.25, 0.02);  // 30 mm deep: half the aperture, two ways
}

TEST(Penumbra, IsAsWideAsTheApertureSeenThroughTheEdge) {
  // at 30 mm the aperture reaches 7.5 mm to either side: through an edge 10 mm deep it sees 5 mm
  const double pitch = Transducer{}.pitch();
  constexpr double kReach = 7.5e-3 * 20 / 30;
  double before = 0;
  for (int k = 0; k < 60; k += 4) {
    const double beside = (k + 1) * pitch;  // from the bone's last line
    const double gain = gains_beside_bone(128 + k, 10e-3)[768];
    EXPECT_GE(gain, before) << k;
    before = gain;
    const double hidden = beside < kReach ? 0.5 * (1 - beside / kReach) : 0;
    EXPECT_NEAR(gain, (1 - hidden) * (1 - hidden), 0.03) << k;
  }
}

TEST(Penumbra, NothingChangesWithoutAShadow) {
  const std::vector<float> shadow_from(256, 1024.0F);
  std::vector<float> re(1024, 0.7F);
  std::vector<float> im(1024, -0.3F);
  add_penumbra(Transducer{}, kSampleDepth, shadow_from, 30, {re, im});
  for (std::size_t i = 0; i < re.size(); ++i) {
    EXPECT_EQ(re[i], 0.7F);
    EXPECT_EQ(im[i], -0.3F);
  }
}

}  // namespace
}  // namespace artus
