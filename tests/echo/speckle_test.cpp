// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

using test::FlatLayer;

const std::array<FlatLayer, 1> kMuscleBlock{{{"muscle", 60e-3}}};

std::shared_ptr<const Scene> lossless_muscle() {
  return test::make_block_scene(kMuscleBlock, [](CompiledJoint& joint) {
    test::acoustic_of(joint, "muscle").attenuation = 0;
  });
}

TEST(Speckle, MuscleHasTheLevelOfTheSettings) {
  ImageSettings settings = test::bare_settings();
  Renderer renderer(lossless_muscle(), Transducer{}, settings);
  const double intensity = test::mean_intensity(renderer.render(test::probe_at()), 4e-3, 36e-3);
  EXPECT_NEAR(10 * std::log10(intensity), settings.speckle_db, 0.7);
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

}  // namespace
}  // namespace artus
