// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "echo/labels.h"
#include "echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

using test::FlatLayer;

/// Loss-free and silent muscle: the needle alone.
std::shared_ptr<const Scene> clear_block() {
  const std::array<FlatLayer, 1> layers{{{"muscle", 60e-3}}};
  return test::make_block_scene(layers, [](CompiledJoint& joint) {
    Acoustic& muscle = test::acoustic_of(joint, "muscle");
    muscle.attenuation = 0;
    muscle.backscatter = 0;
    muscle.speed_of_sound = 1540;
  });
}

/// Grey (0..1, 60 dB) of a needle's shaft where it passes below the middle line at 15 mm.
double shaft_grey(Renderer& renderer, double degrees, bool echogenic) {
  const Pose X_JP = test::probe_at();
  const double angle = degrees * kDegree;
  const Vec3 ahead(6e-3 * std::cos(angle), 0, 15e-3 + 6e-3 * std::sin(angle));
  NeedleView needle = test::needle_at(X_JP, ahead, angle);
  needle.shape.echogenic = echogenic;
  const Frame& frame = renderer.render(X_JP, needle);
  const int peak = test::find_peak(frame, 128, 12e-3, 15.5e-3);
  const double level =
      test::decibel(test::envelope_line(frame, 128)[static_cast<std::size_t>(peak)]);
  return 1 + level / 60;
}

TEST(Needle, GreyFallsInProportionToTheAngle) {
  Renderer renderer(clear_block(), Transducer{}, test::bare_settings());
  std::vector<double> angles;
  std::vector<double> greys;
  for (int degrees = 0; degrees <= 65; degrees += 5) {
    angles.push_back(degrees);
    greys.push_back(shaft_grey(renderer, degrees, false));
    if (greys.size() > 1) {
      EXPECT_LT(greys.back(), greys[greys.size() - 2]) << degrees;
    }
  }
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  const auto n = static_cast<double>(angles.size());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    sx += angles[i], sy += greys[i];
    sxx += angles[i] * angles[i], syy += greys[i] * greys[i], sxy += angles[i] * greys[i];
  }
  const double r = (n * sxy - sx * sy) / std::sqrt((n * sxx - sx * sx) * (n * syy - sy * sy));
  EXPECT_LT(r, -0.95);
}

TEST(Needle, PlainFadesAtSeventyFiveDegreesAndEchogenicStays) {
  Renderer renderer(clear_block(), Transducer{}, test::bare_settings());
  const double plain = shaft_grey(renderer, 75, false) / shaft_grey(renderer, 0, false);
  EXPECT_GE(plain, 0.07);
  EXPECT_LE(plain, 0.13);
  const double dimpled = shaft_grey(renderer, 75, true) / shaft_grey(renderer, 0, true);
  EXPECT_GE(dimpled, 0.55);
  EXPECT_LE(dimpled, 0.65);
}

TEST(Needle, TwentyTwoGaugeRingsEveryHalfMillimetre) {
  Renderer renderer(clear_block(), Transducer{}, test::bare_settings());
  const Pose X_JP = test::probe_at();
  const Frame& frame = renderer.render(X_JP, test::needle_at(X_JP, Vec3(12e-3, 0, 20e-3), 0));
  const auto line = test::envelope_line(frame, 128);
  std::vector<double> peaks;
  for (std::size_t i = 480; i + 1 < 620; ++i) {
    if (line[i] > line[i - 1] && line[i] >= line[i + 1] && line[i] > 0.01F) {
      peaks.push_back(static_cast<double>(i) * frame.sample_depth);
    }
  }
  ASSERT_GE(peaks.size(), 5U);
  for (std::size_t k = 1; k < 5; ++k) {
    EXPECT_NEAR(peaks[k] - peaks[k - 1], 0.51e-3, 0.05e-3);
    EXPECT_LT(line[static_cast<std::size_t>(std::lround(peaks[k] / frame.sample_depth))],
              line[static_cast<std::size_t>(std::lround(peaks[k - 1] / frame.sample_depth))]);
  }
}

TEST(Needle, GaugesRingAtTheirOwnPitch) {
  for (const auto& [gauge, pitch_mm] :
       {std::pair(18, 0.98), {20, 0.70}, {21, 0.61}, {22, 0.51}, {23, 0.43}, {25, 0.34}}) {
    const auto shape = needle_of_gauge(gauge);
    ASSERT_TRUE(shape.has_value());
    EXPECT_NEAR(reverberation_pitch(*shape) * 1e3, pitch_mm, 0.01) << gauge;
  }
  EXPECT_FALSE(needle_of_gauge(19).has_value());
}

TEST(Needle, OutOfPlaneBrightnessFollowsTheSlice) {
  Renderer renderer(clear_block(), Transducer{}, test::bare_settings());
  const Pose X_JP = test::probe_at();
  const auto brightness = [&](double offset) {
    const Frame& frame =
        renderer.render(X_JP, test::needle_at(X_JP, Vec3(12e-3, offset, 30e-3), 0));
    return test::envelope_line(
        frame, 128)[static_cast<std::size_t>(test::find_peak(frame, 128, 28e-3, 31e-3))];
  };
  const double centre = brightness(0);
  double half = 0;
  double before = 1;
  for (int step = 0; step < 80; ++step) {
    const double offset = 0.05e-3 * step;
    const double now = brightness(offset) / centre;
    EXPECT_LT(before - now, 0.15) << offset;  // never a step
    if (now < 0.5 && half == 0) half = offset;
    before = now;
  }
  // slice 1.95 mm wide at 30 mm (6 mm high lens focused at 20 mm), convolved with a 0.717 mm shaft
  EXPECT_NEAR(half, 1.0e-3, 0.2e-3);
}

TEST(Needle, CastsAShadowAndEndsAtItsTip) {
  const std::array<FlatLayer, 1> layers{{{"muscle", 60e-3}}};
  ImageSettings settings = test::bare_settings();
  Renderer renderer(test::make_block_scene(layers), Transducer{}, settings);
  const Pose X_JP = test::probe_at();
  const Frame without = renderer.render(X_JP);
  const Frame& with = renderer.render(X_JP, test::needle_at(X_JP, Vec3(0, 0, 20e-3), 20 * kDegree));
  const auto below = [](const Frame& frame, int first, int last) {
    double sum = 0;
    for (int l = first; l < last; ++l) {
      for (std::size_t i = 700; i < 900; ++i) sum += test::envelope_line(frame, l)[i];
    }
    return sum;
  };
  EXPECT_LT(below(with, 60, 120), 0.7 * below(without, 60, 120));
  EXPECT_DOUBLE_EQ(below(with, 140, 200), below(without, 140, 200));
}

TEST(Needle, TruthTellsTipOffsetAndAngles) {
  const Transducer transducer;
  const ImageSettings settings;
  const Pose X_JP = test::probe_at();
  NeedleView needle = test::needle_at(X_JP, Vec3(3e-3, 0, 20e-3), 30 * kDegree);
  const NeedleTruth in = locate_needle(needle, X_JP, transducer, settings);
  EXPECT_TRUE(in.in_plane);
  EXPECT_NEAR(in.face_angle, 30 * kDegree, 1e-9);
  EXPECT_NEAR(in.plane_angle, 0, 1e-9);
  EXPECT_NEAR(in.tip.x, 23e-3 / settings.pixel - 0.5, 1e-6);
  EXPECT_NEAR(in.tip.y, 20e-3 / settings.pixel - 0.5, 1e-6);
  needle = test::needle_at(X_JP, Vec3(3e-3, 2e-3, 20e-3), 30 * kDegree);
  const NeedleTruth off = locate_needle(needle, X_JP, transducer, settings);
  EXPECT_FALSE(off.in_plane);
  EXPECT_NEAR(off.tip_offset, 2e-3, 1e-12);
}

}  // namespace
}  // namespace artus
