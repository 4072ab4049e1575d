// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <complex>
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

constexpr double kSigmaPerWidth = 1 / 2.3548;

std::shared_ptr<const Scene> wide_lossless_muscle() {
  const std::array<test::FlatLayer, 1> layers{{{"muscle", 60e-3}}};
  return test::make_block_scene(
      layers, [](CompiledJoint& joint) { test::acoustic_of(joint, "muscle").attenuation = 0; });
}

/// Correlation of the complex echoes of two frames, the second read `lines` and `samples` on, 0..1.
double correlation(const Frame& a, const Frame& b, std::size_t lines = 0, std::size_t samples = 0) {
  std::complex<double> product = 0;
  double a2 = 0;
  double b2 = 0;
  const auto n = static_cast<std::size_t>(a.n_samples);
  for (std::size_t l = 20; l < 230; ++l) {
    for (std::size_t i = 60; i + 20 < n; ++i) {
      const std::size_t j = (l + lines) * n + i + samples;
      const std::complex<double> u(a.in_phase[l * n + i], a.quadrature[l * n + i]);
      const std::complex<double> v(b.in_phase[j], b.quadrature[j]);
      product += u * std::conj(v);
      a2 += std::norm(u);
      b2 += std::norm(v);
    }
  }
  return std::abs(product) / std::sqrt(a2 * b2);
}

/// What a Gaussian response of full width `width` has in common with itself `shift` beside it.
double gaussian_overlap(double shift, double width) {
  return std::exp(-std::pow(shift / (width * kSigmaPerWidth), 2) / 4);
}

class SpeckleMotion : public ::testing::Test {
 protected:
  Transducer transducer_;
  ImageSettings settings_ = test::bare_settings();
  Renderer renderer_{wide_lossless_muscle(), transducer_, settings_};
  double lateral_ = 0.97 * transducer_.wavelength() * transducer_.f_number;
  double axial_ = transducer_.pulse_cycles * transducer_.wavelength() / 2;
};

TEST_F(SpeckleMotion, ChangesWithoutAJumpWhenTheProbeMovesByPartsOfALine) {
  const Frame still = renderer_.render(test::probe_at());
  for (const double share : {0.125, 0.25, 0.5, 0.75}) {
    const double shift = share * transducer_.pitch();
    const double measured = correlation(still, renderer_.render(test::probe_at(shift)));
    RecordProperty("lateral_" + std::to_string(share), std::to_string(measured));
    EXPECT_GT(measured, gaussian_overlap(shift, lateral_) - 0.15) << share;
  }
}

TEST_F(SpeckleMotion, ChangesWithoutAJumpWhenTheProbePressesOrSlides) {
  const Frame still = renderer_.render(test::probe_at());
  const double pressed = correlation(still, renderer_.render(test::probe_at(0, 0, 10e-6)));
  const double slid = correlation(still, renderer_.render(test::probe_at(0, 50e-6)));
  RecordProperty("axial_10um", std::to_string(pressed));
  RecordProperty("elevation_50um", std::to_string(slid));
  EXPECT_GT(pressed, 0.85);
  EXPECT_GT(slid, 0.8);
}

TEST_F(SpeckleMotion, IsAsWideAsTheBeamAndThePulse) {
  const Frame& frame = renderer_.render(test::probe_at());
  // the scatterers' own size widens a little; 15 % more in width is 0.06 in correlation here
  EXPECT_NEAR(correlation(frame, frame, 1), gaussian_overlap(transducer_.pitch(), lateral_), 0.1);
  EXPECT_NEAR(correlation(frame, frame, 0, 2), gaussian_overlap(2 * frame.sample_depth, axial_),
              0.1);
  EXPECT_LT(correlation(frame, frame, 4), 0.05);
  EXPECT_LT(correlation(frame, frame, 0, 12), 0.05);
}

TEST_F(SpeckleMotion, HasThePowerOfTheSettingsInEveryView) {
  for (int k = 0; k < 23; ++k) {  // lattices blend on the way
    const double turn = 2.0 * k * kDegree;
    const Vec3 lateral(std::cos(turn), std::sin(turn), 0);
    const Pose X_JP = make_pose(Vec3::Zero(), Vec3::UnitZ(), lateral);
    const double level = 10 * std::log10(test::mean_intensity(renderer_.render(X_JP), 4e-3, 36e-3));
    EXPECT_NEAR(level, settings_.speckle_db, 0.7) << k;
  }
}

TEST_F(SpeckleMotion, KeepsMostOfItselfWhenTheProbeTurnsALittle) {
  for (int k = 0; k < 30; ++k) {
    const auto turned = [&](double degrees) {
      return make_pose(Vec3::Zero(), Vec3::UnitZ(),
                       Vec3(std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0));
    };
    const Frame before = renderer_.render(turned(k));
    EXPECT_GT(correlation(before, renderer_.render(turned(k + 0.02))), 0.8) << k;
  }
}

}  // namespace
}  // namespace artus
