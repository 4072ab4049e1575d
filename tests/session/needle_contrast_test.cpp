// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/record/needle_contrast.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kDepth = 20e-3;  // m, of the tip under the middle of the face

/// A picture whose envelope is what `amplitude` says of a place relative to the tip: m along x and
/// along z.
Frame picture_of(const Transducer& transducer,
                 const std::function<double(double x, double z)>& amplitude) {
  Frame frame;
  frame.n_lines = transducer.n_lines;
  frame.n_samples = 800;
  frame.sample_depth = 50e-6;
  frame.pixel = 0.1e-3;
  frame.width = 400;
  frame.height = 400;
  frame.tip_shown = PixelPoint{199.5, kDepth / frame.pixel - 0.5};
  for (int i = 0; i < frame.n_lines; ++i) {
    const Scanline line = scanline(transducer, i);
    for (int k = 0; k < frame.n_samples; ++k)
      frame.envelope.push_back(
          static_cast<float>(amplitude(line.origin.x(), k * frame.sample_depth - kDepth)));
  }
  return frame;
}

/// A needle that comes from the left at 30 degrees, its tip where the picture shows it.
FrameInput needle_input() {
  FrameInput input;
  input.has_needle = 1;
  input.X_JP = to_plain(Pose::Identity());
  const Vec3 axis(std::cos(30 * kDegree), 0, std::sin(30 * kDegree));
  input.X_JN = to_plain(make_pose(Vec3(0, 0, kDepth), axis, Vec3::UnitY()));
  return input;
}

/// m from the line of that needle.
double beside(double x, double z) {
  return std::abs(x * std::sin(30 * kDegree) - z * std::cos(30 * kDegree));
}

/// A needle in the plane, as far as `end` m before its tip, in what is around it.
std::optional<double> contrast_of_line(const std::function<double(double, double)>& around,
                                       double end = 0) {
  const Transducer transducer;
  const Vec3 axis(std::cos(30 * kDegree), 0, std::sin(30 * kDegree));
  const auto amplitude = [&](double x, double z) {
    const bool shaft = beside(x, z) < 0.35e-3 && x * axis.x() + z * axis.z() < -end;
    return shaft ? 4.0 : around(x, z);
  };
  return needle_contrast(needle_input(), picture_of(transducer, amplitude), transducer);
}
double even(double, double) {
  return 1;
}
constexpr double kChoice = 2;  // dB that the brightest of a few lines has of itself

TEST(NeedleContrast, IsThatOfTheShaftsEndBesideItLessTheChoiceOfItsLine) {
  const auto contrast = contrast_of_line(even);
  ASSERT_TRUE(contrast.has_value());
  EXPECT_NEAR(*contrast, 20 * std::log10(4) - kChoice, 0.3);
}

TEST(NeedleContrast, WhatIsDarkAtTheTipIsNotSeenHoweverBrightTheShaft) {
  const auto contrast = contrast_of_line(even, 2.5e-3);
  ASSERT_TRUE(contrast.has_value());
  EXPECT_NEAR(*contrast, -kChoice, 0.3);
}

TEST(NeedleContrast, ABrightLayerBesideTheLineAndAStrandAcrossDoNotHideIt) {
  const auto skin = contrast_of_line([](double x, double z) {
    return x * std::sin(30 * kDegree) - z * std::cos(30 * kDegree) > 1.6e-3 ? 4.0 : 1.0;
  });
  const auto strand =
      contrast_of_line([](double x, double) { return std::abs(x + 2e-3) < 0.1e-3 ? 30.0 : 1.0; });
  ASSERT_TRUE(skin && strand);
  EXPECT_GT(*skin, 4);
  EXPECT_GT(*strand, 4);
}

TEST(NeedleContrast, AShaftAcrossThePlaneIsAPointOverTheSpeckleWithThatMedian) {
  const Transducer transducer;
  const Frame frame = picture_of(
      transducer, [](double x, double z) { return std::hypot(x, z) < 1e-3 ? 4.0 : 1.0; });
  FrameInput input = needle_input();
  input.X_JN = to_plain(make_pose(Vec3(0, 0, kDepth), Vec3(0, 0.8, 0.6), Vec3::UnitX()));
  const auto contrast = needle_contrast(input, frame, transducer);
  ASSERT_TRUE(contrast.has_value());
  EXPECT_NEAR(*contrast, 20 * std::log10(4) + 10 * std::log10(std::numbers::ln2), 1e-9);
}

TEST(NeedleContrast, NothingWhereNothingOfTheTipShows) {
  const Transducer transducer;
  Frame frame = picture_of(transducer, [](double, double) { return 1.0; });
  frame.tip_shown.reset();
  EXPECT_FALSE(needle_contrast(needle_input(), frame, transducer).has_value());
}

}  // namespace
}  // namespace artus
