// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/probe/beam_profile.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

const std::array<test::FlatLayer, 1> kOptionsBlock{{{"muscle", 60e-3}}};

std::shared_ptr<const Scene> lossless(double backscatter) {
  return test::make_block_scene(kOptionsBlock, [&](CompiledJoint& joint) {
    test::acoustic_of(joint, "muscle").attenuation = 0;
    test::acoustic_of(joint, "muscle").backscatter = backscatter;
  });
}

/// Mean over standard deviation of the envelope well inside the image.
double speckle_snr(const Frame& frame) {
  double sum = 0;
  double squares = 0;
  double n = 0;
  for (int l = 40; l < 216; ++l) {
    for (const float a : test::envelope_line(frame, l).subspan(100, 800)) {
      sum += a;
      squares += static_cast<double>(a) * a;
      ++n;
    }
  }
  const double mean = sum / n;
  return mean / std::sqrt(squares / n - mean * mean);
}

TEST(Options, CompoundingAveragesSpeckleAway) {
  ImageSettings settings = test::bare_settings();
  const auto scene = lossless(1);
  Renderer plain(scene, Transducer{}, settings);
  EXPECT_NEAR(speckle_snr(plain.render(test::probe_at())), 1.91, 0.08);
  settings.compound_angles = 3;
  settings.compound_spread = 0.3;
  Renderer compound(scene, Transducer{}, settings);
  // three independent looks: sqrt(3) times the ratio, 3.3, and a little more, as the steered ones
  // are read between their lines
  const double ratio = speckle_snr(compound.render(test::probe_at()));
  EXPECT_GT(ratio, 3.1);
  EXPECT_LT(ratio, 4.1);
}

TEST(Options, CompoundingLeavesThingsWhereTheyAre) {
  ImageSettings settings = test::bare_settings();
  settings.compound_angles = 5;
  Renderer renderer(lossless(0), Transducer{}, settings);
  renderer.set_point_reflectors({{Vec3(4e-3, 0, 20e-3), 1}});
  const Frame& frame = renderer.render(test::probe_at());
  const auto brightest = std::max_element(frame.envelope.begin(), frame.envelope.end());
  const auto at = static_cast<int>(brightest - frame.envelope.begin());
  const Transducer transducer;
  EXPECT_NEAR((at / frame.n_samples) * transducer.pitch() - transducer.width / 2, 4e-3, 0.16e-3);
  EXPECT_NEAR((at % frame.n_samples) * frame.sample_depth, 20e-3, 0.05e-3);
}

TEST(Options, SmoothingNarrowsTheSpreadOfGrey) {
  const auto spread = [](double smoothing) {
    ImageSettings settings = test::bare_settings();
    settings.smoothing = smoothing;
    settings.dynamic_range_db = 100;
    const Frame frame = render_bmode(lossless(1), test::probe_at(), std::nullopt, {}, settings);
    double sum = 0;
    double squares = 0;
    const auto first = frame.decibel.begin() + 100 * frame.n_samples;
    const auto last = frame.decibel.begin() + 150 * frame.n_samples;
    std::for_each(first, last, [&](float db) {
      sum += db;
      squares += static_cast<double>(db) * db;
    });
    const double n = 50.0 * frame.n_samples;
    return std::sqrt(squares / n - sum / n * (sum / n));
  };
  const double plain = spread(0);
  const double half = spread(0.5);
  const double full = spread(1);
  EXPECT_LT(half, plain - 0.3);
  EXPECT_LT(full, half - 0.3);
}

TEST(Options, TransmitFocusIsSharpestAtItsDepth) {
  Transducer transducer;
  const BeamProfile everywhere(transducer, 50e-3);
  transducer.transmit_focus = 20e-3;
  const BeamProfile focused(transducer, 50e-3);
  EXPECT_NEAR(focused.lateral_width(20e-3), everywhere.lateral_width(20e-3), 1e-9);
  for (const double z : {8e-3, 12e-3, 30e-3, 40e-3}) {
    EXPECT_GT(focused.lateral_width(z), 1.15 * everywhere.lateral_width(z)) << z;
    // never wider than the received beam alone
    EXPECT_LT(focused.lateral_width(z), std::sqrt(2.0) * everywhere.lateral_width(z) + 1e-9) << z;
  }
}

/// Colours of a needle that moves along its shaft at `speed`, toward the tip.
std::vector<float> velocities(double speed) {
  ImageSettings settings = test::bare_settings();
  settings.doppler = true;
  Renderer renderer(lossless(1), Transducer{}, settings);
  const Pose X_JP = test::probe_at();
  NeedleView needle = test::needle_at(X_JP, Vec3(2e-3, 0, 20e-3), 30 * kDegree);
  needle.v_JN = speed * needle.X_JN.linear().col(2);
  std::vector<float> found;
  for (const float v : renderer.render(X_JP, needle).velocity) {
    if (!std::isnan(v)) found.push_back(v);
  }
  return found;
}

TEST(Options, DopplerShowsHowFastTheNeedleGoesAway) {
  const std::vector<float> found = velocities(0.05);
  ASSERT_GT(found.size(), 100U);
  for (const float v : found) ASSERT_NEAR(v, -0.05 * std::sin(30 * kDegree), 1e-6);
}

TEST(Options, DopplerWrapsRoundBeyondItsLimit) {
  const std::vector<float> found = velocities(0.3);  // 0.15 m/s away, limit 0.1
  ASSERT_GT(found.size(), 100U);
  for (const float v : found) ASSERT_NEAR(v, 0.05, 1e-6);
}

TEST(Options, DopplerIgnoresANeedleAtRest) {
  EXPECT_TRUE(velocities(0).empty());
}

TEST(Options, ATrackShowsFaintlyWhereTheNeedleWas) {
  Renderer renderer(lossless(0), Transducer{}, test::bare_settings());
  const Pose X_JP = test::probe_at();
  EXPECT_LT(test::mean_intensity(renderer.render(X_JP), 5e-3, 35e-3), 1e-15);
  renderer.set_needle_tracks({{Vec3(-15e-3, 0, 5e-3), Vec3(5e-3, 0, 25e-3), 0.025}});
  const Frame& frame = renderer.render(X_JP);
  for (const int l : {60, 90, 120, 150}) {
    const Transducer transducer;
    const double x = transducer.pitch() * l - transducer.width / 2;
    const auto line = test::envelope_line(frame, l);
    const auto peak = std::max_element(line.begin(), line.end());
    EXPECT_NEAR(static_cast<double>(peak - line.begin()) * frame.sample_depth,
                (x + 20e-3) * 1540 / 1562, 0.5e-3);
    EXPECT_LT(*peak, 0.2F);
  }
  const auto beyond = test::envelope_line(frame, 220);
  EXPECT_LT(*std::max_element(beyond.begin(), beyond.end()), 1e-6F);
}

}  // namespace
}  // namespace artus
