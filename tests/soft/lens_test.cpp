// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/lens.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

TEST(Lens, HoldsItsVolumeAndKeepsItsShape) {
  for (const double volume : {0.05e-6, 1e-6, 5e-6}) {
    const double radius = lens_radius(volume);
    double held = 0;
    constexpr int kRings = 2000;
    for (int k = 0; k < kRings; ++k) {
      const double r = radius * (k + 0.5) / kRings;
      held += lens_height(volume, r) * 2 * std::numbers::pi * r * radius / kRings;
    }
    EXPECT_NEAR(held, volume, 1e-5 * volume);
    EXPECT_NEAR(lens_height(8 * volume, 0), 2 * lens_height(volume, 0), 1e-12);
    EXPECT_EQ(lens_height(volume, 1.001 * radius), 0);
  }
  EXPECT_EQ(lens_height(0, 0), 0);
}

}  // namespace
}  // namespace artus
