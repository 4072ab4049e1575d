// SPDX-License-Identifier: AGPL-3.0-or-later
// Truth as the picture shows it: places, borders and needles where their echoes are.
#include "artus/detail/echo/display/shown_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

constexpr double kFat = 1462;     // m/s
constexpr double kMuscle = 1562;  // m/s

std::shared_ptr<const Scene> fat_over_muscle(double fat) {
  const std::array<FlatLayer, 3> layers{{{"fat", fat}, {"muscle", 12e-3}, {"bone", 30e-3}}};
  return test::make_block_scene(layers, [](CompiledJoint& joint) {
    for (const char* name : {"fat", "muscle"}) {
      test::acoustic_of(joint, name).attenuation = 0;
      test::acoustic_of(joint, name).backscatter = 0;
    }
  });
}

TEST(ShownPlaces, AreDelayedByTheTissuesSpeeds) {
  const ImageSettings settings = test::bare_settings();
  const Renderer renderer(fat_over_muscle(10e-3), Transducer{}, settings);
  const ShownPlaces places = renderer.shown_places(test::probe_at());
  const double sample_depth = settings.depth / settings.n_samples;
  const auto shown = [](double fat, double muscle) {
    return 1540 * (fat / kFat + muscle / kMuscle);
  };
  for (const auto& [fat, muscle] :
       {std::pair(4e-3, 0.0), std::pair(10e-3, 1e-3), std::pair(10e-3, 11e-3)}) {
    const double sample = shown(fat, muscle) / sample_depth;
    for (const int line : {0, 100, Transducer{}.n_lines - 1}) {
      EXPECT_NEAR(places.place(line, sample).z(), fat + muscle, 1e-9);
      EXPECT_NEAR(places.sample_of(line, fat + muscle), sample, 1e-6);
    }
  }
  // behind bone the line goes on at the scanner's speed
  const double bone = shown(10e-3, 12e-3) / sample_depth;
  EXPECT_NEAR(places.place(9, bone + 100).z(), 22e-3 + 100 * sample_depth, 2e-6);
  EXPECT_EQ(places.region(9, bone - 1), kFirstRegion + 1);
  EXPECT_EQ(places.region(9, bone + 1), kFirstRegion + 2);
  EXPECT_EQ(places.region(9, settings.n_samples - 1.0), kFirstRegion + 2);
}

TEST(ShownPlaces, AProbeInTheAirShowsNothingButWhatLiesStraightAhead) {
  const ImageSettings settings = test::bare_settings();
  const Renderer renderer(fat_over_muscle(10e-3), Transducer{}, settings);
  const ShownPlaces places = renderer.shown_places(test::probe_at(0, 0, -10e-3));
  const double sample_depth = settings.depth / settings.n_samples;
  EXPECT_EQ(places.region(20, 9e-3 / sample_depth), kOutside);
  EXPECT_EQ(places.region(20, 11e-3 / sample_depth), kFirstRegion);
}

/// The row of a column, between two, whose pixel is the brightest, or that the most over `without`.
int brightest_row(const Frame& frame, int x, int from, int to,
                  const std::vector<std::uint8_t>* without = nullptr) {
  int best = from;
  const auto grey = [&](int y) {
    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                           static_cast<std::size_t>(x);
    return frame.image[at] - (without == nullptr ? 0 : (*without)[at]);
  };
  for (int y = from; y < to; ++y)
    if (grey(y) > grey(best)) best = y;
  return best;
}

TEST(ShownLabels, ABorderLiesWithinHalfAPixelOfItsEcho) {
  ImageSettings settings = test::bare_settings();
  Renderer renderer(fat_over_muscle(10e-3), Transducer{}, settings);
  const Pose X_JP = test::probe_at();
  const Frame& frame = renderer.render(X_JP);
  const LabelImage shown = render_shown_labels(renderer, X_JP);
  const LabelImage real = render_labels(*fat_over_muscle(10e-3), X_JP, {}, settings);
  for (int x = 40; x < frame.width - 40; x += 7) {
    const auto first_of = [&](const LabelImage& labels, RegionId region) {
      int y = 0;
      while (labels.regions[static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
                            static_cast<std::size_t>(x)] != region)
        ++y;
      return y;
    };
    const int border = first_of(shown, kFirstRegion + 1);
    const double echo = 1540 * 10e-3 / kFat / settings.pixel - 0.5;  // pixels
    EXPECT_NEAR(border - 0.5, echo, 0.5 + 0.4) << "a border lies between two pixels, and samples";
    EXPECT_NEAR(brightest_row(frame, x, border - 15, border + 15), echo, 1);
    EXPECT_NEAR(first_of(shown, kFirstRegion + 2) - first_of(real, kFirstRegion + 2),
                (1540 * (10e-3 / kFat + 12e-3 / kMuscle) - 22e-3) / settings.pixel, 1);
  }
}

class ShownNeedle : public ::testing::TestWithParam<std::tuple<Look, double>> {};

/// The student's test: in 95 % of the columns the brightest row lies in the mask.
TEST_P(ShownNeedle, IsWhereItsBrightestRowIs) {
  const auto [look, degrees] = GetParam();
  ImageSettings settings = test::bare_settings();
  settings.look = look;
  settings.refraction = true;
  Renderer renderer(fat_over_muscle(58e-3), Transducer{}, settings);
  const Pose X_JP = test::probe_at();
  const NeedleView needle = test::needle_at(X_JP, Vec3(8e-3, 0, 31e-3), degrees * kDegree);
  const std::vector<std::uint8_t> without = renderer.render(X_JP).image;  // borders are bright, too
  const Frame& frame = renderer.render(X_JP, needle);
  const LabelImage shown = render_shown_labels(renderer, X_JP, needle);
  const LabelImage real = render_labels(*fat_over_muscle(58e-3), X_JP, {}, settings, needle);
  int columns = 0;
  int in_shown = 0;
  int in_real = 0;
  const int top = static_cast<int>(4e-3 / settings.pixel);
  const int bone = static_cast<int>(37e-3 / settings.pixel);
  for (int x = 0; x < frame.width; ++x) {
    const auto has = [&](const LabelImage& labels, int y) {
      return labels.needle[static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
                           static_cast<std::size_t>(x)] != 0;
    };
    bool any = false;
    for (int y = top; y < bone; ++y) any = any || has(shown, y);
    if (!any) continue;
    ++columns;
    const int row = brightest_row(frame, x, top, bone, &without);
    in_shown += has(shown, row) ? 1 : 0;
    in_real += has(real, row) ? 1 : 0;
  }
  EXPECT_GT(columns, 60);
  EXPECT_GE(in_shown, 0.95 * columns);
  if (degrees < 20) {
    EXPECT_LT(in_real, 0.6 * columns) << "the echo is 1.6 mm too deep";
  }
}
INSTANTIATE_TEST_SUITE_P(LooksAndAngles, ShownNeedle,
                         ::testing::Combine(::testing::Values(Look::raw, Look::clinical),
                                            ::testing::Values(0.0, 10.0, 25.0, 40.0)));

}  // namespace
}  // namespace artus
