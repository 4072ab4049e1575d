// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/echo_phantom.h"

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

Frame render(const EchoPhantom& phantom) {
  Renderer renderer(phantom.scene, Transducer{}, bare_settings());
  renderer.set_point_reflectors(phantom.reflectors);
  return renderer.render(phantom.X_JP, phantom.needle);
}

TEST(EchoPhantom, EveryNameMakesABodyThatGivesEchoesWithItsTruth) {
  for (const auto name : echo_phantoms()) {
    const auto phantom = make_echo_phantom(name);
    ASSERT_TRUE(phantom.has_value()) << name;
    EXPECT_EQ(phantom->name, name);
    EXPECT_FALSE(phantom->truth.empty()) << name;
    EXPECT_GT(mean_intensity(render(*phantom), 2e-3, 38e-3), 0) << name;
  }
}

TEST(EchoPhantom, LayersLieWhereTheTruthSaysTheyAreShown) {
  const auto phantom = make_echo_phantom("layers");
  const Frame frame = render(*phantom);
  for (const auto& layer : phantom->truth.at("layers")) {
    const double shown = layer.at("displayed_top_mm").get<double>() * kMillimetre;
    if (layer.at("tissue") != "fat" && layer.at("tissue") != "bone") continue;  // the strongest
    EXPECT_NEAR(find_peak(frame, 128, shown - 0.4e-3, shown + 0.4e-3) * frame.sample_depth, shown,
                2 * frame.sample_depth)
        << layer;
  }
}

TEST(EchoPhantom, TheCystIsDarkAndTheTissueBelowItBright) {
  const auto phantom = make_echo_phantom("cyst");
  const Frame frame = render(*phantom);
  const auto level = [&](int first, int last, double from, double to) {
    double sum = 0;
    for (int l = first; l < last; ++l)
      for (double z = from; z < to; z += frame.sample_depth) {
        const double a = envelope_line(frame, l)[static_cast<std::size_t>(z / frame.sample_depth)];
        sum += a * a;
      }
    return decibel_of_intensity(sum / (last - first) / (to - from));
  };
  EXPECT_LT(level(120, 136, 18e-3, 22e-3), level(20, 60, 18e-3, 22e-3) - 20);
  EXPECT_GT(level(120, 136, 27e-3, 34e-3), level(20, 60, 27e-3, 34e-3) + 4);
}

TEST(EchoPhantom, WhatCannotBeIsRefused) {
  EXPECT_EQ(make_echo_phantom("block").error().code, ErrorCode::not_found);
  PhantomOptions options;
  options.needle_angle = 90 * kDegree;
  EXPECT_EQ(make_echo_phantom("needle", options).error().code, ErrorCode::invalid);
  options = {};
  options.needle_depth = -1;
  EXPECT_EQ(make_echo_phantom("needle", options).error().code, ErrorCode::invalid);
}

}  // namespace
}  // namespace artus
