// SPDX-License-Identifier: AGPL-3.0-or-later
// What an aperture hears beside one weakened ray; bone and needle as screens show them.
#include "artus/detail/echo/acquire/aperture_light.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

constexpr int kLitSamples = 1024;

/// A trace of one run to `end` whose sound arrives with `amplitude`.
void set_run(BeamTrace& trace, double amplitude, double end) {
  trace.clear();
  BeamRun& run = trace.runs[trace.n_runs++];
  run.begin = 0;
  run.end = end;
  run.log_gain_begin = run.log_gain_end = std::log(amplitude);
}

class ApertureLightTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int l = 0; l < 256; ++l) note(l, 1, 2000);
  }
  void note(int l, double amplitude, double end) {
    set_run(*trace_, amplitude, end);
    light_.note(l, *trace_);
  }
  /// What a sample of ones becomes.
  float applied(int l, std::size_t sample) {
    std::vector<float> re(kLitSamples, 1.0F);
    std::vector<float> im(kLitSamples, 1.0F);
    light_.apply(l, {re, im});
    EXPECT_EQ(re[sample], im[sample]);
    return re[sample];
  }
  std::unique_ptr<BeamTrace> trace_ = std::make_unique<BeamTrace>();
  ApertureLight light_{Transducer{}, 40e-3, kLitSamples};
};

TEST_F(ApertureLightTest, LinesThatAllHearTheSameStayAsTheyAre) {
  EXPECT_EQ(applied(100, 900), 1.0F);
}

TEST_F(ApertureLightTest, ANarrowDarkStripIsHeardByTheRestOfTheAperture) {
  for (int l = 96; l <= 104; ++l) note(l, 0.5, 2000);
  // 30 mm deep the aperture is 15 mm wide: most of what serves line 100 hears with 1
  EXPECT_GT(0.5F * applied(100, 768), 0.6F);
  EXPECT_LT(0.5F * applied(100, 768), 0.95F);
  EXPECT_EQ(applied(60, 100), 1.0F);               // far from it
  EXPECT_LT(applied(100, 64), applied(100, 768));  // a small aperture looks past less
}

TEST_F(ApertureLightTest, NoRayIsRaisedByMoreThanSixDecibels) {
  note(100, 1e-6, 2000);
  EXPECT_FLOAT_EQ(applied(100, 768), 2.0F);
}

TEST_F(ApertureLightTest, ALineThatGoesOnAloneIsAsItIs) {
  for (int l = 0; l < 256; ++l)
    if (l != 100) note(l, 1, 50);
  for (const std::size_t sample : {100U, 300U, 500U, 768U, 1000U})
    EXPECT_EQ(applied(100, sample), 1.0F) << sample;
}

TEST_F(ApertureLightTest, LinesThatEndAtBoneCountNoMore) {
  for (int l = 0; l < 128; ++l) note(l, 1, 500);
  EXPECT_EQ(applied(128, 900), 1.0F);
  EXPECT_EQ(applied(100, 900), 1.0F);
}

TEST(NeedleOnScreen, IsANarrowPeakOnAPlateau) {
  const auto decibels = [](double degrees, bool echogenic) {
    NeedleShape shape;
    shape.echogenic = echogenic;
    return test::decibel(needle_on_screen(shape, degrees * kDegree));
  };
  EXPECT_GT(decibels(0, false) - decibels(20, false), 15);
  EXPECT_LT(decibels(20, false) - decibels(50, false), 6);
  for (int degrees = 0; degrees < 90; degrees += 5) {
    EXPECT_GT(decibels(degrees, false), decibels(degrees + 5, false));
    EXPECT_GE(decibels(degrees, true), decibels(degrees, false));
  }
  EXPECT_DOUBLE_EQ(decibels(-30, false), decibels(30, false));
}

/// The brightest envelope below `from` (m) of a needle in silence, over that of its shaft, dB.
double copy_of_needle(double degrees) {
  const auto scene = test::make_block_scene(std::array<test::FlatLayer, 1>{{{"muscle", 60e-3}}},
                                            [](CompiledJoint& joint) {
                                              for (Tissue& tissue : joint.tissues)
                                                tissue.acoustic = {};
                                            });
  ImageSettings settings = test::bare_settings();
  settings.look = Look::clinical;
  const double angle = degrees * kDegree;
  const Vec3 tip = Vec3(0, 0, 12e-3) + 6e-3 * Vec3(std::cos(angle), 0, std::sin(angle));
  const Frame frame = render_bmode(scene, test::probe_at(),
                                   test::needle_at(test::probe_at(), tip, angle), {}, settings);
  const auto peak = [&](double from, double to) {
    return static_cast<double>(test::envelope_line(
        frame, 128)[static_cast<std::size_t>(test::find_peak(frame, 128, from, to))]);
  };
  return test::decibel(std::max(1e-9, peak(21e-3, 26e-3)) / peak(9e-3, 14e-3));
}

TEST(NeedleOnScreen, HasACopyAtTwiceItsDepthOnlyWhereItLiesFlat) {
  EXPECT_LT(copy_of_needle(5), -45);
  EXPECT_GT(copy_of_needle(0), copy_of_needle(5) + 10);
}

TEST(BoneOnScreen, IsOneEvenLineAtAnySlopeAndNothingRepeatsBelow) {
  ImageSettings settings;
  settings.clutter = false;  // the acquisition alone
  settings.n_threads = 2;
  const std::array<test::FlatLayer, 3> layers{{{"skin", 2e-3}, {"muscle", 12e-3}, {"bone", 40e-3}}};
  const Frame frame =
      render_bmode(test::make_block_scene(layers), test::probe_at(), {}, {}, settings);
  double most = 0;
  for (int l = 0; l < frame.n_lines; ++l) {
    const auto line = test::envelope_line(frame, l);
    most = std::max(most, static_cast<double>(*std::max_element(line.begin() + 600, line.end())));
  }
  EXPECT_LT(most, 1e-3);  // -60 dB
}

}  // namespace
}  // namespace artus
