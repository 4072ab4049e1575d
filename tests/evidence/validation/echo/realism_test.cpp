// SPDX-License-Identifier: AGPL-3.0-or-later
// Reading pictures as a sonographer: known lines, known speckle, the look in its bands.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/echo/realism_gates.h"
#include "artus/detail/evidence/validation/echo/realism_scenes.h"
#include "artus/detail/evidence/validation/echo/screen_measures.h"
#include "artus/detail/evidence/validation/gates.h"

namespace artus {
namespace {

constexpr double kPixel = 0.1e-3;  // m

/// A line of `thickness` px (down the column) that falls by `slope`, grey 160 on 40; `gap` columns
/// of every 20 have none.
struct DrawnLine {
  cv::Mat image{200, 200, CV_8UC1, cv::Scalar(40)};
  std::vector<double> surface;
  DrawnLine(double slope, int thickness, int gap) {
    for (int x = 0; x < image.cols; ++x) {
      surface.push_back(60 + slope * x);
      if (x % 20 < gap) continue;
      const int row = static_cast<int>(std::lround(surface.back()));
      for (int y = row; y < std::min(image.rows, row + thickness); ++y)
        image.at<std::uint8_t>(y, x) = 160;
    }
  }
};

TEST(ScreenMeasures, FindsALineItsThicknessAndItsGaps) {
  const DrawnLine flat(0, 12, 0);
  const BoneLine line = measure_bone_line(flat.image, flat.surface, kPixel, 0, 0.3);
  EXPECT_EQ(line.columns, 190);
  EXPECT_EQ(line.found, 1);
  EXPECT_NEAR(line.thickness, 1.2e-3, 1e-5);
  EXPECT_EQ(line.mean, 160);
  EXPECT_LT(line.evenness, 1e-9);
  const DrawnLine broken(0, 12, 5);
  EXPECT_NEAR(measure_bone_line(broken.image, broken.surface, kPixel, 0, 0.3).found, 0.75, 0.03);
  EXPECT_GT(measure_bone_line(broken.image, broken.surface, kPixel, 0, 0.3).evenness, 0.3);
}

TEST(ScreenMeasures, TellsThicknessAcrossASlope) {
  const DrawnLine steep(0.5, 12, 0);
  const double slope = std::atan(0.5);
  const BoneLine line = measure_bone_line(steep.image, steep.surface, kPixel, 0.3, 1);
  EXPECT_NEAR(line.thickness, 1.2e-3 * std::cos(slope), 0.05e-3);
  EXPECT_EQ(measure_bone_line(steep.image, steep.surface, kPixel, 0, 0.3).columns, 0);
}

TEST(ScreenMeasures, SkewnessIsThatOfBrightDotsOrDarkOnes) {
  cv::Mat dots(100, 100, CV_8UC1, cv::Scalar(60));
  for (std::uint64_t k = 0; k < 200; ++k)
    dots.at<std::uint8_t>(static_cast<int>(100 * uniform_noise(1, 2 * k)),
                          static_cast<int>(100 * uniform_noise(1, 2 * k + 1))) = 200;
  EXPECT_GT(fine_skewness(dots), 1);
  EXPECT_LT(fine_skewness(255 - dots), -1);
  EXPECT_EQ(fine_skewness(cv::Mat(20, 20, CV_8UC1, cv::Scalar(60))), 0);
}

TEST(ScreenMeasures, PercentilesAreThoseOfTheMask) {
  cv::Mat image(10, 10, CV_8UC1);
  for (int i = 0; i < 100; ++i) image.at<std::uint8_t>(i / 10, i % 10) = static_cast<uchar>(i);
  cv::Mat mask = cv::Mat::zeros(10, 10, CV_8UC1);
  mask.rowRange(5, 10) = 255;
  const auto grey = sorted_grey(image, mask);
  EXPECT_EQ(grey.size(), 50U);
  EXPECT_EQ(sorted_percentile(grey, 0), 50);
  EXPECT_EQ(sorted_percentile(grey, 1), 99);
  EXPECT_EQ(sorted_percentile({}, 0.5), 0);
}

TEST(Realism, TheClinicalLookIsInTheBandsOfRealPictures) {
  for (const char* name : {"bone", "needle", "lumen", "muscle"}) {
    const auto gate = run_gate("realism", name);
    ASSERT_TRUE(gate.has_value()) << gate.error().to_string();
    EXPECT_FALSE(gate->claims.empty());
    for (const Claim& claim : gate->claims)
      EXPECT_TRUE(claim.pass) << name << ": " << claim.text << ": " << claim.value;
  }
}

TEST(Realism, PlatesNeedTheFolderOfRealPictures) {
  EXPECT_FALSE(run_gate("realism", "plates").has_value());
  const auto names = gate_names("realism", {});
  EXPECT_EQ(std::count(names.begin(), names.end(), "plates"), 0);
  const auto plates = measure_plates("no-such-folder");
  ASSERT_FALSE(plates.has_value());
  EXPECT_EQ(plates.error().code, ErrorCode::not_found);
}

TEST(Realism, TheNeedlePassesBelowTheMiddleOfTheFace) {
  const ScreenNeedle needle = make_screen_needle(0.4);
  const Vec3 middle = needle.tip - 8e-3 * needle.axis;
  EXPECT_NEAR((middle - Vec3(0, 0, 15e-3)).norm(), 0, 1e-9);
  EXPECT_NEAR(needle.pixel_of(middle).y, 149.5, 1e-6);
}

}  // namespace
}  // namespace artus
