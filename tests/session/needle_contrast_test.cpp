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

TEST(NeedleContrast, IsThatOfTheTipOverTheSpeckleWithThatMedian) {
  const Transducer transducer;
  const Frame frame = picture_of(
      transducer, [](double x, double z) { return std::hypot(x, z) < 1e-3 ? 4.0 : 1.0; });
  const auto contrast = needle_contrast(needle_input(), frame, transducer);
  ASSERT_TRUE(contrast.has_value());
  EXPECT_NEAR(*contrast, 20 * std::log10(4) + 10 * std::log10(std::numbers::ln2), 1e-9);
}

TEST(NeedleContrast, NeitherTheOwnShaftNorOneStrandTakesIt) {
  const Transducer transducer;
  const auto tip = [](double x, double z) {
    return std::hypot(x, z) < 1e-3 ? 4.0 : 1.0;
  };
  const auto plain = needle_contrast(needle_input(), picture_of(transducer, tip), transducer);
  const auto shaft = needle_contrast(
      needle_input(),
      picture_of(
          transducer,
          [&](double x, double z) { return x < 0 && beside(x, z) < 0.8e-3 ? 9.0 : tip(x, z); }),
      transducer);
  const auto strand = needle_contrast(
      needle_input(),
      picture_of(
          transducer,
          [&](double x, double z) { return std::abs(z - 3e-3) < 0.3e-3 ? 30.0 : tip(x, z); }),
      transducer);
  ASSERT_TRUE(plain && shaft && strand);
  EXPECT_GE(*shaft, *plain);
  EXPECT_NEAR(*strand, *plain, 1e-9);
}

TEST(NeedleContrast, NothingWhereNothingOfTheTipShows) {
  const Transducer transducer;
  Frame frame = picture_of(transducer, [](double, double) { return 1.0; });
  frame.tip_shown.reset();
  EXPECT_FALSE(needle_contrast(needle_input(), frame, transducer).has_value());
}

}  // namespace
}  // namespace artus
