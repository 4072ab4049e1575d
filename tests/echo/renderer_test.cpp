// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "artus/detail/echo/display/display.h"
#include "artus/echo/labels.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

using test::FlatLayer;

const std::array<FlatLayer, 4> kLayers{
    {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 14e-3}, {"bone", 20e-3}}};

TEST(Renderer, LabelsSayWhatLiesInThePlane) {
  const auto scene = test::make_block_scene(kLayers);
  const ImageSettings settings;
  const LabelImage labels = render_labels(*scene, test::probe_at(), Transducer{}, settings);
  const auto at = [&](double depth) {
    const auto y = static_cast<std::size_t>(depth / settings.pixel);
    return scene->joint()
        .regions[labels.regions[y * static_cast<std::size_t>(labels.width) + 200]]
        .name;
  };
  EXPECT_EQ(at(1e-3), "skin");
  EXPECT_EQ(at(5e-3), "fat");
  EXPECT_EQ(at(15e-3), "muscle");
  EXPECT_EQ(at(30e-3), "bone");
}

TEST(Renderer, BadSettingsAreRefusedAndOddPosesAreBlack) {
  const auto scene = test::make_block_scene(kLayers);
  Transducer transducer;
  transducer.n_lines = 10000;
  EXPECT_FALSE(validate(transducer).has_value());
  EXPECT_THROW(Renderer(scene, transducer, ImageSettings{}), std::invalid_argument);
  transducer = {};
  transducer.width = 0;
  EXPECT_FALSE(validate(transducer).has_value());
  transducer = {};
  transducer.frequency = 1e12;
  EXPECT_FALSE(validate(transducer).has_value());
  ImageSettings settings;
  settings.depth = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(validate(settings).has_value());

  Renderer renderer(scene, Transducer{}, test::raw_settings());
  const Frame& inside_bone = renderer.render(test::probe_at(0, 0, 30e-3));
  EXPECT_EQ(*std::max_element(inside_bone.image.begin(), inside_bone.image.end()), 0);
  const Frame& far_off = renderer.render(test::probe_at(1, 1, -1));
  EXPECT_EQ(far_off.image.back(), 0);
}

TEST(Renderer, CompressionIsTwentyTimesTheLogarithm) {
  std::vector<float> envelope;
  for (int k = 0; k < 340; ++k) {
    envelope.push_back(static_cast<float>(1e-9 * std::pow(1.07, k)));
  }
  std::vector<float> levels(envelope.size());
  compress(envelope, 3, levels);
  for (std::size_t i = 0; i < envelope.size(); ++i) {
    EXPECT_NEAR(levels[i], 20 * std::log10(static_cast<double>(envelope[i])) + 3, 0.01);
  }
}

TEST(Renderer, GainAndDynamicRangeMoveTheGreyScale) {
  const auto scene = test::make_block_scene(kLayers);
  const auto mean_grey = [&](double gain, double range) {
    ImageSettings settings = test::raw_settings();
    settings.gain_db = gain;
    settings.dynamic_range_db = range;
    const Frame frame = render_bmode(scene, test::probe_at(), std::nullopt, {}, settings);
    double sum = 0;
    const std::size_t first = 100 * static_cast<std::size_t>(frame.width);
    const std::size_t last = 180 * static_cast<std::size_t>(frame.width);
    for (std::size_t i = first; i < last; ++i) sum += frame.image[i];
    return sum / static_cast<double>(last - first);
  };
  const double plain = mean_grey(0, 80);
  EXPECT_NEAR(mean_grey(8, 80) - plain, 8 * 255.0 / 80, 0.5);
  EXPECT_GT(plain, mean_grey(0, 60));
}

TEST(Renderer, CurvedProbeFansOut) {
  const auto scene = test::make_block_scene(kLayers);
  Transducer transducer;
  transducer.radius = 40e-3;
  transducer.frequency = 5e6;
  ImageSettings settings;
  settings.gel_limit = 10e-3;
  const Frame frame = render_bmode(scene, test::probe_at(), std::nullopt, transducer, settings);
  EXPECT_GT(frame.width * frame.pixel, 60e-3);
  EXPECT_EQ(frame.image[0], 0);  // beside the sector
}

}  // namespace
}  // namespace artus
