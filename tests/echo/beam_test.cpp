// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/acquire/beam_spread.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/echo/probe/beam_profile.h"
#include "artus/echo/renderer.h"
#include "artus/echo/transducer_file.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

using test::FlatLayer;

/// Field at (x, z) of an aperture focused at `focus`, by the paraxial integral.
std::complex<double> field(double x, double z, double aperture, double focus, double wave_number) {
  constexpr int kNodes = 400;
  std::complex<double> sum = 0;
  for (int i = 0; i < kNodes; ++i) {
    const double s = aperture * ((i + 0.5) / kNodes - 0.5);
    sum += std::polar(1.0, wave_number * ((x - s) * (x - s) / (2 * z) - s * s / (2 * focus)));
  }
  return sum;
}

/// Two-way width at depth `z`: received with the focus and F-number kept, sent with one focus.
double integrated_width(const Transducer& t, double z) {
  std::vector<double> offset;
  std::vector<double> value;
  const double receive = std::min(z / t.f_number, t.max_aperture);
  const double transmit = std::min(t.transmit_focus / t.f_number, t.max_aperture);
  for (int k = 0; k < 200; ++k) {
    offset.push_back(k * 0.01e-3);
    double sum = 0;
    for (int j = -4; j <= 4; ++j) {  // the pulse's spectrum
      const double u = 0.5 * j;
      const double frequency = t.frequency * (1 + u * t.bandwidth / 2.355);
      const double wave_number = 2 * std::numbers::pi * frequency / kDisplaySpeedOfSound;
      sum += std::exp(-u * u / 2) *
             std::abs(field(offset.back(), z, transmit, t.transmit_focus, wave_number) *
                      field(offset.back(), z, receive, z, wave_number));
    }
    value.push_back(sum);
  }
  return full_width(offset, value);
}

TEST(Beam, WithOneTransmitFocusIsSharpThereAndElsewhereAsWideAsReceptionAlone) {
  const auto preset = find_transducer("linear-4-9");
  ASSERT_TRUE(preset.has_value());
  const Transducer& t = preset->transducer;
  ASSERT_EQ(t.transmit_focus, 25e-3);
  const BeamProfile profile(t, 50e-3);
  const double closed = kTwoWayWidth * t.wavelength() * t.f_number;
  EXPECT_NEAR(profile.lateral_width(25e-3), closed, 1e-9);
  for (const double z : {12e-3, 17e-3, 35e-3}) {
    const double wider = profile.lateral_width(z) / profile.lateral_width(25e-3);
    EXPECT_NEAR(wider, integrated_width(t, z) / integrated_width(t, 25e-3), 0.1 * wider) << z;
  }
  Transducer everywhere = t;
  everywhere.transmit_focus = 0;
  EXPECT_NEAR(BeamProfile(everywhere, 50e-3).lateral_width(12e-3), closed, 1e-9);
}

/// Two straight pieces that bend at 10 mm by `slope`.
BeamPath bent_path(double x, double slope) {
  BeamPath path;
  path.p_J[0] = Vec3(x, 0, 0);
  path.p_J[1] = Vec3(x, 0, 10e-3);
  path.p_J[2] = Vec3(x + slope * 40e-3, 0, 50e-3);
  path.length[0] = 0;
  path.length[1] = 10e-3;
  path.length[2] = 50e-3;
  path.size = 3;
  return path;
}

TEST(Beam, ThinsOutWhereNeighboursDriftApart) {
  Transducer t;
  BeamSpread spread(t, 40e-3, 1024);
  const int middle = t.n_lines / 2;
  // 20 mm below the bend neighbours are twice as far apart
  for (int l = 0; l < t.n_lines; ++l)
    spread.note(l, bent_path(scanline(t, l).origin.x(), (l - middle) * t.pitch() / 20e-3));
  std::vector<float> re(1024, 1.0F);
  std::vector<float> im(1024, 1.0F);
  spread.apply(middle, {re, im});
  EXPECT_EQ(re[200], 1.0F);  // above the bend
  EXPECT_NEAR(re[768], 0.5, 0.02);
  EXPECT_EQ(re, im);
  for (int l = 0; l < t.n_lines; ++l) spread.note(l, bent_path(scanline(t, l).origin.x(), 0.1));
  std::vector<float> parallel(1024, 1.0F);
  spread.apply(middle, {parallel, im});
  EXPECT_GT(*std::min_element(parallel.begin(), parallel.end()), 0.999F);
}

TEST(Beam, FadesTowardTotalReflectionWithoutAStep) {
  RegionAcoustics fat;
  fat.speed = 1462;
  fat.impedance = 1462.0 * 927;
  RegionAcoustics tendon;
  tendon.speed = 1750;
  tendon.impedance = 1750.0 * 1121;
  double before = 1;
  for (int degrees = 0; degrees < 80; ++degrees) {
    const double cosine = std::cos(degrees * kDegree);
    const double now =
        beam_transmission(fat, tendon, cosine, compute_interface(fat, tendon, cosine));
    EXPECT_LT(std::abs(now - before), 0.25) << degrees;
    before = now;
  }
  EXPECT_EQ(before, 0);  // beyond the critical angle (56.7 degrees) of every direction
  const double critical = std::cos(57 * kDegree);
  EXPECT_GT(beam_transmission(fat, tendon, critical, compute_interface(fat, tendon, critical)),
            0.2);
}

TEST(Beam, RoughSurfacesReturnWhatTheirFacingFacetsReflect) {
  for (const double roughness : {0.0, 0.3, 1.0}) {
    const ReturnedShare upright = returned_share(roughness, 1);
    EXPECT_DOUBLE_EQ(upright.specular + upright.diffuse, 1);
    const ReturnedShare at_20 = returned_share(roughness, std::cos(20 * kDegree));
    EXPECT_NEAR(at_20.specular, (1 - roughness) * std::exp(-400.0 / 144), 1e-4);
    EXPECT_NEAR(at_20.diffuse, roughness * std::cos(20 * kDegree), 1e-12);
  }
  RegionAcoustics muscle;
  muscle.speed = 1562;
  muscle.impedance = 1562.0 * 1058;
  RegionAcoustics bone;
  bone.speed = 3194;
  bone.impedance = 3194.0 * 1862;
  const double upright = compute_interface(muscle, bone, 1).reflection;
  const InterfaceResponse steep = compute_interface(muscle, bone, std::cos(50 * kDegree));
  EXPECT_EQ(steep.reflection, 1);
  EXPECT_DOUBLE_EQ(steep.facing, upright);
}

TEST(Beam, HazeInABonesShadowRepeatsTheTissueAboveIt) {
  const std::array<FlatLayer, 2> layers{{{"muscle", 15e-3}, {"bone", 30e-3}}};
  const auto scene = test::make_block_scene(layers, [](CompiledJoint& joint) {
    for (const char* name : {"muscle", "bone"}) {
      Acoustic& a = test::acoustic_of(joint, name);
      a.attenuation = 0;
    }
    test::acoustic_of(joint, "muscle").speed_of_sound = 1540;
  });
  ImageSettings settings = test::bare_settings();
  settings.reverberation = true;
  settings.depth = 28e-3;  // bone's own repeat lies deeper
  Renderer renderer(scene, Transducer{}, settings);
  const Frame& frame = renderer.render(test::probe_at());
  const double tissue = test::mean_intensity(frame, 3e-3, 11e-3);
  const double haze = test::mean_intensity(frame, 18e-3, 26e-3);
  const double bone = 3194.0 * 1862 / (1540.0 * 1058);
  const double expected = 0.1 * (bone - 1) / (bone + 1);
  EXPECT_NEAR(std::sqrt(haze / tissue), expected, 0.15 * expected);
}

TEST(BeamProfile, OfARodAsMuchIsHeardAsOfItsWallAcrossTheSlice) {
  const Transducer t;
  const BeamProfile profile(t, 40e-3);
  for (const double z : {8e-3, 20e-3, 30e-3}) {
    const double middle = profile.elevation_amplitude(0, z);
    for (int k = 0; k <= 8; ++k) {
      const double y = 0.1e-3 * k;
      EXPECT_NEAR(profile.elevation_share(y, z, 0),
                  std::min(1.0, profile.elevation_amplitude(y, z) / middle), 1e-12);
      EXPECT_DOUBLE_EQ(profile.elevation_share(y, z, 0.36e-3),
                       profile.elevation_share(-y, z, 0.36e-3));
    }
  }
  // In the focus the slice is thinner than the rod, which is heard farther out than a thread.
  EXPECT_GT(profile.elevation_share(0.3e-3, 20e-3, 0.36e-3),
            1.3 * profile.elevation_share(0.3e-3, 20e-3, 0));
}

}  // namespace
}  // namespace artus
