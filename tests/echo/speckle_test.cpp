// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

using test::FlatLayer;

constexpr std::array<FlatLayer, 1> kMuscleBlock{{{"muscle", 60e-3}}};

std::shared_ptr<const Scene> lossless_muscle() {
  return test::make_block_scene(kMuscleBlock, [](CompiledJoint& joint) {
    test::acoustic_of(joint, "muscle").attenuation = 0;
  });
}

/// Envelopes one per resolution cell, from several independent bodies.
std::vector<double> independent_envelopes() {
  std::vector<double> cells;
  const auto scene = lossless_muscle();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    ImageSettings settings = test::bare_settings();
    settings.seed = seed;
    Renderer renderer(scene, Transducer{}, settings);
    const Frame& frame = renderer.render(test::probe_at());
    for (int l = 6; l < frame.n_lines - 6; l += 4) {
      const auto line = test::envelope_line(frame, l);
      for (std::size_t i = 40; i + 20 < line.size(); i += 12) cells.push_back(line[i]);
    }
  }
  return cells;
}

TEST(Speckle, IsFullyDevelopedInAHomogeneousBlock) {
  std::vector<double> cells = independent_envelopes();
  ASSERT_GE(cells.size(), 10000U);
  const Moments envelope = moments_of(cells);
  RecordProperty("snr", std::to_string(envelope.mean / envelope.deviation));
  EXPECT_NEAR(envelope.mean / envelope.deviation, 1.91, 0.05);
  std::vector<double> levels;
  for (const double a : cells) levels.push_back(test::decibel(a));
  EXPECT_NEAR(moments_of(levels).deviation, 5.57, 0.2);
}

TEST(Speckle, EnvelopeIsRayleighByKolmogorovAndSmirnov) {
  std::vector<double> cells = independent_envelopes();
  std::sort(cells.begin(), cells.end());
  double squares = 0;
  for (const double a : cells) squares += a * a;
  const auto n = static_cast<double>(cells.size());
  const double power = squares / n;
  double distance = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double expected = 1 - std::exp(-cells[i] * cells[i] / power);
    distance = std::max({distance, std::abs(expected - static_cast<double>(i) / n),
                         std::abs(expected - static_cast<double>(i + 1) / n)});
  }
  EXPECT_LT(distance, 1.63 / std::sqrt(n));  // 1 % level
}

TEST(Speckle, MuscleHasTheLevelOfTheSettings) {
  ImageSettings settings = test::bare_settings();
  Renderer renderer(lossless_muscle(), Transducer{}, settings);
  const double intensity = test::mean_intensity(renderer.render(test::probe_at()), 4e-3, 36e-3);
  EXPECT_NEAR(10 * std::log10(intensity), settings.speckle_db, 0.7);
}

TEST(Speckle, FallsByTwiceTheAttenuationTimesFrequency) {
  const auto scene = test::make_block_scene(kMuscleBlock);
  Renderer renderer(scene, Transducer{}, test::bare_settings());
  const Frame& frame = renderer.render(test::probe_at());
  double sx = 0;
  double sy = 0;
  double sxx = 0;
  double sxy = 0;
  int n = 0;
  for (; n < 32; ++n) {
    const double z = 3e-3 + 1e-3 * n;
    // decibel of the mean intensity against true depth (the display shows it at 1540 m/s)
    const double y = 10 * std::log10(test::mean_intensity(frame, z, z + 1e-3));
    const double x = (z + 0.5e-3) * 1562 / 1540;
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  EXPECT_NEAR(slope / 100, -2 * 0.75 * 12, 0.02 * 2 * 0.75 * 12);  // dB/cm
}

TEST(Speckle, DownshiftKeepsPartOfTheLoss) {
  const auto scene = test::make_block_scene(kMuscleBlock);
  ImageSettings settings = test::bare_settings();
  Renderer plain(scene, Transducer{}, settings);
  const double without = test::mean_intensity(plain.render(test::probe_at()), 19e-3, 21e-3);
  settings.frequency_downshift = true;
  Renderer shifted(scene, Transducer{}, settings);
  const double with = test::mean_intensity(shifted.render(test::probe_at()), 19e-3, 21e-3);
  // A Gaussian spectrum of deviation s keeps exp(S^2 s^2 / 2) of the amplitude, S Np/Hz the slope.
  const double slope = 2 * 0.75 * 100 / kDecibelPerNeper * 1e-6 * 20e-3 * 1562 / 1540;
  const double sigma = 12e6 * 0.5 / 2.355;
  const double expected = kDecibelPerNeper * 0.5 * std::pow(slope * sigma, 2);
  EXPECT_NEAR(10 * std::log10(with / without), expected, 0.1 * expected);
}

TEST(Speckle, MovesByOneLineWhenTheProbeMovesByOnePitch) {
  const Transducer transducer;
  Renderer renderer(lossless_muscle(), transducer, test::bare_settings());
  const Frame before = renderer.render(test::probe_at());
  const Frame& after = renderer.render(test::probe_at(transducer.pitch()));
  double product = 0;
  double a2 = 0;
  double b2 = 0;
  for (int l = 20; l < 230; ++l) {
    const auto a = test::envelope_line(before, l + 1);
    const auto b = test::envelope_line(after, l);
    for (std::size_t i = 30; i < a.size(); ++i) {
      product += static_cast<double>(a[i]) * b[i];
      a2 += static_cast<double>(a[i]) * a[i];
      b2 += static_cast<double>(b[i]) * b[i];
    }
  }
  EXPECT_GT(product / std::sqrt(a2 * b2), 0.999);
}

TEST(Speckle, TendonFadesWithTiltAndMuscleHardly) {
  const auto level = [](const char* tissue, double degrees) {
    const std::array<FlatLayer, 1> block{{{tissue, 60e-3}}};
    const auto scene = test::make_block_scene(block, [&](CompiledJoint& joint) {
      test::acoustic_of(joint, tissue).attenuation = 0;
      const double tilt = degrees * kDegree;
      joint.regions.back().fibre_axis = Vec3(std::cos(tilt), 0, std::sin(tilt));
    });
    Renderer renderer(scene, Transducer{}, test::bare_settings());
    return 10 * std::log10(test::mean_intensity(renderer.render(test::probe_at()), 5e-3, 35e-3));
  };
  const double muscle = level("muscle", 0);
  const double peak = level("tendon", 0);
  EXPECT_GT(peak, muscle + 3);
  EXPECT_GT(level("tendon", 2), muscle);
  EXPECT_LT(level("tendon", 7), muscle);
  EXPECT_LT(level("tendon", 20), peak - 10);
  EXPECT_NEAR(level("muscle", 20), muscle, 3);
}

}  // namespace
}  // namespace artus
