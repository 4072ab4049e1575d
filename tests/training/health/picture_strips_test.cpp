// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/picture_strips.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

/// Grey that layers and speckle would give: bands of depth that slope gently, and grain that
/// neighbouring lines share half of. `shift`: samples by which each line is displaced.
template <class Shift>
Frame layered_frame(Shift shift) {
  Frame frame;
  frame.n_lines = 128;
  frame.n_samples = 512;
  frame.sample_depth = 40e-3 / 512;
  const auto grain = [](int line, int sample) {
    const auto bits = mix_bits(static_cast<std::uint64_t>(line * 4099 + sample));
    return 12 * (static_cast<double>(bits >> 11U) / 9007199254740992.0 - 0.5);
  };
  for (int line = 0; line < frame.n_lines; ++line)
    for (int i = 0; i < frame.n_samples; ++i) {
      const int at = i - shift(line);
      const double bands = 12 * std::sin(0.05 * at + 0.01 * line) + 6 * std::sin(0.013 * at);
      const double speckle = (grain(line / 2, at) + grain((line + 1) / 2 + 1000, at)) / 2;
      frame.decibel.push_back(static_cast<float>(-30 + bands + speckle));
    }
  return frame;
}

constexpr double kPitch = 40e-3 / 127;  // m

TEST(PictureStrips, ALayeredPictureHasNone) {
  EXPECT_LT(share_of_strips(layered_frame([](int) { return 0; }), kPitch), 0.002);
  EXPECT_LT(share_of_strips(layered_frame([](int line) { return line / 2; }), kPitch), 0.002);
}

TEST(PictureStrips, ColumnsDisplacedAgainstEachOtherAreFound) {
  const double many =
      share_of_strips(layered_frame([](int line) { return (line / 8) % 2 == 0 ? 0 : 45; }), kPitch);
  const double one =
      share_of_strips(layered_frame([](int line) { return line < 50 ? 0 : 45; }), kPitch);
  EXPECT_GT(many, 0.05);
  EXPECT_GT(one, 0.003);
  EXPECT_GT(many, 5 * one);
}

TEST(PictureStrips, WhatShowsNothingIsLeftOut) {
  Frame broken = layered_frame([](int line) { return (line / 8) % 2 == 0 ? 0 : 45; });
  broken.contact.assign(128, 0.0F);
  EXPECT_EQ(share_of_strips(broken, kPitch), 0);
  Frame black = broken;
  black.contact.clear();
  black.decibel.assign(black.decibel.size(), -120.0F);
  EXPECT_EQ(share_of_strips(black, kPitch), 0);
}

}  // namespace
}  // namespace artus
