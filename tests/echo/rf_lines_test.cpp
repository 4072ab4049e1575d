// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/rf_lines.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kPi = std::numbers::pi;

/// A pulse of closed form on the middle of three lines: a Gaussian of known phase at `at` samples.
struct Pulse {
  double at = 100.3;
  double width = 3;  // samples, standard deviation
  double phase = 0.7;
  [[nodiscard]] std::complex<double> value(double sample) const {
    const double u = (sample - at) / width;
    return std::polar(std::exp(-0.5 * u * u), phase);
  }
};

Frame frame_of(const Pulse& pulse, const Transducer& transducer, const ImageSettings& settings) {
  Frame frame;
  frame.n_lines = transducer.n_lines;
  frame.n_samples = settings.n_samples;
  frame.sample_depth = settings.depth / settings.n_samples;
  const auto n = static_cast<std::size_t>(frame.n_samples);
  frame.in_phase.resize(static_cast<std::size_t>(frame.n_lines) * n);
  frame.quadrature.resize(frame.in_phase.size());
  for (std::size_t i = 0; i < n; ++i) {
    const auto value = pulse.value(static_cast<double>(i));
    frame.in_phase[n + i] = static_cast<float>(value.real());
    frame.quadrature[n + i] = static_cast<float>(value.imag());
  }
  return frame;
}

class RfLinesTest : public testing::Test {
 protected:
  RfLinesTest() {
    transducer_.n_lines = 3;
    settings_.n_samples = 256;
    settings_.depth = 10e-3;
  }
  Transducer transducer_;
  ImageSettings settings_;
  Pulse pulse_;
};

TEST_F(RfLinesTest, APulseOfClosedFormRidesOnTheCarrier) {
  const auto lines =
      make_rf_lines(frame_of(pulse_, transducer_, settings_), transducer_, settings_);
  ASSERT_TRUE(lines) << lines.error().message;
  EXPECT_NEAR(lines->sampling_frequency, 1540 / (2 * 10e-3 / 256), 1e-3);
  EXPECT_GE(lines->rf_sampling_frequency, 4 * transducer_.frequency);
  const auto n = static_cast<std::size_t>(lines->n_rf_samples);
  const double factor = lines->rf_sampling_frequency / lines->sampling_frequency;
  ASSERT_EQ(lines->n_rf_samples, factor * 256);
  ASSERT_EQ(lines->rf.size(), 3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto sample = static_cast<double>(i);
    const double turn = 2 * kPi * transducer_.frequency * sample / lines->rf_sampling_frequency;
    const double expected = (pulse_.value(sample / factor) * std::polar(1.0, turn)).real();
    EXPECT_NEAR(lines->rf[n + i], expected, 2e-4) << i;
    EXPECT_EQ(lines->rf[i], 0);
  }
}

TEST_F(RfLinesTest, TheEnvelopeIsTheTimeGainTimesTheLinesThatAreGiven) {
  const auto lines =
      make_rf_lines(frame_of(pulse_, transducer_, settings_), transducer_, settings_);
  ASSERT_TRUE(lines);
  EXPECT_EQ(lines->time_gain.front(), 1);
  // both ways, dB: 2 * 0.7 dB/cm/MHz * 12 MHz * the last sample's depth
  const double depth_cm = 1 - 1.0 / 256;
  EXPECT_NEAR(20 * std::log10(lines->time_gain.back()),
              2 * settings_.tgc_db_cm_mhz * transducer_.frequency / 1e6 * depth_cm, 1e-4);
}

TEST_F(RfLinesTest, EachArrayHasTheShapeOfItsValues) {
  transducer_.radius = 60e-3;
  const auto lines =
      make_rf_lines(frame_of(pulse_, transducer_, settings_), transducer_, settings_);
  ASSERT_TRUE(lines);
  EXPECT_LT(lines->origins[2], 0);  // the curved face falls away from its middle
  for (const NamedArray& array : arrays_of(*lines)) {
    std::size_t size = 1;
    for (const std::size_t n : array.shape) size *= n;
    std::visit([&](const auto& values) { EXPECT_EQ(values.size(), size) << array.name; },
               array.values);
  }
}

TEST_F(RfLinesTest, ACompoundPictureHasNone) {
  const Frame frame = frame_of(pulse_, transducer_, settings_);
  settings_.compound_angles = 3;
  const auto steered = make_rf_lines(frame, transducer_, settings_);
  ASSERT_FALSE(steered);
  EXPECT_EQ(steered.error().code, ErrorCode::invalid);
  settings_.compound_angles = 1;
  EXPECT_TRUE(check_single_lines(settings_));
  settings_.look = Look::compound;
  EXPECT_FALSE(check_single_lines(settings_));
}

}  // namespace
}  // namespace artus
