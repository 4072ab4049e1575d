// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

using test::FlatLayer;

/// Makes every tissue silent and free of loss, so that interfaces stand alone.
void silence(CompiledJoint& joint) {
  for (Tissue& tissue : joint.tissues) {
    tissue.acoustic.attenuation = 0;
    tissue.acoustic.backscatter = 0;
  }
}

TEST(Interface, NothingReturnsFromBehindBone) {
  const std::array<FlatLayer, 3> layers{{{"muscle", 15e-3}, {"bone", 5e-3}, {"muscle", 30e-3}}};
  const auto scene = test::make_block_scene(layers);
  ImageSettings settings = test::bare_settings();
  Renderer renderer(scene, Transducer{}, settings);
  const Frame& frame = renderer.render(test::probe_at());
  EXPECT_LT(test::mean_intensity(frame, 20e-3, 38e-3), 1e-20);
  EXPECT_NEAR(frame.shadow_from[128] * frame.sample_depth, 15e-3 * 1540 / 1562, 0.1e-3);
}

TEST(Interface, WithoutContactTheImageIsBlackBelowTheRingingLens) {
  const std::array<FlatLayer, 1> layers{{{"muscle", 40e-3}}};
  const auto scene = test::make_block_scene(layers);
  Renderer renderer(scene, Transducer{}, test::raw_settings());
  const Frame& frame = renderer.render(test::probe_at(0, 0, -20e-3));
  EXPECT_GT(test::envelope_line(frame, 128)[1], 0.5F);
  const auto below = static_cast<std::size_t>(20e-3 / frame.pixel);
  for (std::size_t i = below * static_cast<std::size_t>(frame.width); i < frame.image.size(); ++i) {
    ASSERT_EQ(frame.image[i], 0) << i;
  }
}

TEST(Interface, SnellBendsTheRefractedBeam) {
  RegionAcoustics fat;
  fat.speed = 1462;
  fat.impedance = 1462.0 * 927;
  RegionAcoustics muscle;
  muscle.speed = 1562;
  muscle.impedance = 1562.0 * 1058;
  for (const auto& [degrees, bend] : {std::pair(20.0, 1.4), {30.0, 2.3}, {45.0, 4.1}}) {
    const InterfaceResponse response = compute_interface(fat, muscle, std::cos(degrees * kDegree));
    const double out = std::acos(response.cosine_out) / kDegree;
    EXPECT_NEAR(std::sin(out * kDegree) / std::sin(degrees * kDegree), 1562.0 / 1462, 1e-9);
    EXPECT_NEAR(out - degrees, bend, 0.1);
  }
  RegionAcoustics bone;
  bone.speed = 3194;
  bone.impedance = 3194.0 * 1862;
  EXPECT_LT(compute_interface(muscle, bone, std::cos(28.9 * kDegree)).reflection, 1);
  EXPECT_EQ(compute_interface(muscle, bone, std::cos(29.7 * kDegree)).reflection, 1);
}

TEST(Interface, RefractionShiftsWhatLiesBehindAnObliqueLayer) {
  // A bone plane seen through a tilted probe: the bent beam reaches it elsewhere than the straight.
  const std::array<FlatLayer, 3> layers{{{"fat", 10e-3}, {"muscle", 10e-3}, {"bone", 30e-3}}};
  const auto scene = test::make_block_scene(layers, silence);
  Transducer transducer;
  transducer.steering = 25 * kDegree;
  ImageSettings settings = test::bare_settings();
  const auto depth_of_bone = [&] {
    Renderer renderer(scene, transducer, settings);
    const Frame& frame = renderer.render(test::probe_at());
    return frame.shadow_from[128] * frame.sample_depth;
  };
  const double bent = depth_of_bone();
  settings.refraction = false;
  const double straight = depth_of_bone();
  const double c = std::cos(25 * kDegree);
  const double sine = std::sin(25 * kDegree) * 1562 / 1462;
  const double fat = 10e-3 / c * 1540 / 1462;
  EXPECT_NEAR(straight, fat + 10e-3 / c * 1540 / 1562, 0.08e-3);
  EXPECT_NEAR(bent, fat + 10e-3 / std::sqrt(1 - sine * sine) * 1540 / 1562, 0.08e-3);
  EXPECT_GT(bent, straight + 0.1e-3);
}

}  // namespace
}  // namespace artus
