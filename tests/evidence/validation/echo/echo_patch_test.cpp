// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/echo/echo_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/detail/evidence/validation/echo/echo_muscle_view.h"
#include "artus/echo/transducer_file.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

namespace fs = std::filesystem;

fs::path reference() {
  const char* shared = std::getenv("ARTUS_SHARED");
  return (shared != nullptr ? fs::path(shared) : artus::test::source_dir() / ".." / "shared") /
         "data/us_reference";
}

/// Width of the autocorrelation, along the first axis, of white noise that Gaussians of the
/// deviations `along` and `across` smoothed, less its own blur by 12 px: three Gaussians.
double expected_width(double along, double across) {
  const double a = 2 * along * along;
  const double b = 2 * across * across;
  std::vector<double> lag;
  std::vector<double> value;
  for (int k = 0; k < 400; ++k) {
    lag.push_back(0.1 * k);
    double sum = 0;
    for (const auto& [factor, blur] : {std::pair(1.0, 0.0), {-2.0, 144.0}, {1.0, 288.0}})
      sum += factor * std::sqrt(a * b / ((a + blur) * (b + blur))) *
             std::exp(-lag.back() * lag.back() / (2 * (a + blur)));
    value.push_back(sum);
  }
  return full_width(lag, value);
}

TEST(EchoPatch, MeasuresTheWidthsOfSmoothedNoise) {
  cv::Mat noise(400, 400, CV_64F);
  cv::RNG random(7);
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  cv::Mat smooth;
  cv::GaussianBlur(noise, smooth, {}, 4, 1.5);
  cv::Mat image;
  smooth.convertTo(image, CV_8U, 100, 128);
  const PatchStatistics s = measure_patch(image, {0, 0, 400, 400});
  EXPECT_NEAR(s.mean, 128, 1);
  EXPECT_NEAR(s.axial_width, expected_width(1.5, 4), 0.25);
  EXPECT_NEAR(s.lateral_width, expected_width(4, 1.5), 0.5);
}

TEST(EchoPatch, SlowChangesOfBrightnessDoNotCount) {
  cv::Mat noise(96, 96, CV_64F);
  cv::RNG random(7);
  random.fill(noise, cv::RNG::NORMAL, 128, 20);
  cv::Mat flat;
  noise.convertTo(flat, CV_8U);
  for (int x = 0; x < 96; ++x) noise.col(x) += 0.6 * x - 30;
  cv::Mat tilted;
  noise.convertTo(tilted, CV_8U);
  const cv::Rect all(0, 0, 96, 96);
  EXPECT_NEAR(measure_patch(tilted, all).lateral_width, measure_patch(flat, all).lateral_width,
              0.2);
}

TEST(EchoPatch, AgreesWithThePublishedTableOfRealImages) {
  if (!fs::exists(reference() / "stats.tsv")) GTEST_SKIP() << "no reference images";
  // The table is the mean of five patches of which it names the first; one patch of a picture may
  // differ, the middle of all pictures must not.
  std::ifstream table(reference() / "stats.tsv");
  std::string line;
  std::getline(table, line);
  std::vector<double> axial;
  std::vector<double> lateral;
  while (std::getline(table, line)) {
    std::istringstream in(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(in, cell, '\t');) cells.push_back(cell);
    int x = 0, y = 0, w = 0, h = 0;
    ASSERT_EQ(std::sscanf(cells.at(2).c_str(), "%d,%d,%d,%d", &x, &y, &w, &h), 4);
    for (const auto& entry : fs::recursive_directory_iterator(reference())) {
      if (entry.path().filename() != cells[0]) continue;
      const cv::Mat image = cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE);
      const PatchStatistics s = measure_patch(image, {x, y, w, h});
      axial.push_back(s.axial_width / std::stod(cells.at(10)));
      lateral.push_back(s.lateral_width / std::stod(cells.at(11)));
    }
  }
  ASSERT_GE(axial.size(), 15U);
  for (auto* ratios : {&axial, &lateral}) {
    std::sort(ratios->begin(), ratios->end());
    EXPECT_NEAR((*ratios)[ratios->size() / 2], 1, 0.07);
  }
}

TEST(EchoPatch, MeasuresPatchesOfMuscleAloneAndSaysWhenThereAreNone) {
  const PatchRange range{{0, 0, 0, 0}, {255, 255, 96, 96}, 1};
  const std::array<FlatLayer, 2> layers{{{"fat", 8e-3}, {"muscle", 60e-3}}};
  const Gate gate = measure_muscle(make_block_scene(layers), range);
  ASSERT_EQ(gate.claims.size(), 15U);
  for (const Claim& claim : gate.claims) {
    EXPECT_TRUE(claim.pass) << claim.text;
    EXPECT_EQ(claim.basis.kind, ClaimKind::fitted) << claim.text;
    EXPECT_FALSE(claim.basis.why.empty()) << claim.text;
  }
  const std::array<FlatLayer, 1> fat{{{"fat", 60e-3}}};
  const Gate none = measure_muscle(make_block_scene(fat), range);
  ASSERT_EQ(none.claims.size(), 7U);
  EXPECT_FALSE(none.claims[0].pass);

  LabelImage labels;
  labels.width = 40;
  labels.height = 30;
  labels.regions.assign(40 * 30, kFirstRegion + 1);
  for (std::size_t x = 0; x < 40; ++x) labels.regions[10 * 40 + x] = kFirstRegion;  // fat
  const auto patches = find_muscle_patches(labels, make_block_scene(layers)->joint(), 16, 9);
  ASSERT_EQ(patches.size(), 2U);
  for (const cv::Rect& patch : patches) EXPECT_GT(patch.y, 10);
  EXPECT_TRUE((patches[0] & patches[1]).empty());
}

TEST(EchoPatch, LooksWhereFibresRunAlongTheFaceAsInTheReference) {
  const auto preset = find_transducer("linear-4-9");
  ASSERT_TRUE(preset.has_value());
  ImageSettings settings;
  settings.look = Look::raw;
  settings.pixel = 0.0854e-3;
  settings.depth = 50e-3;
  const std::array<FlatLayer, 2> layers{{{"fat", 8e-3}, {"muscle", 60e-3}}};
  const auto with_fibres = [&](double degrees) {
    return make_block_scene(layers, [&](CompiledJoint& joint) {
      const double slope = degrees * kDegree;
      joint.regions.back().fibre_axis = Vec3(std::cos(slope), 0, std::sin(slope));
    });
  };
  const auto along = with_fibres(15);
  const MuscleFinder finder(*along, preset->transducer, settings);
  EXPECT_EQ(finder.find_patches(Pose::Identity(), 96, 5).size(), 5U);
  const auto here = finder.slide_to_muscle(Pose::Identity(), 96);
  ASSERT_TRUE(here.has_value());
  EXPECT_TRUE(here->isApprox(Pose::Identity()));
  const auto steep = with_fibres(35);
  const MuscleFinder other(*steep, preset->transducer, settings);
  EXPECT_TRUE(other.find_patches(Pose::Identity(), 96, 5).empty());
  EXPECT_FALSE(other.slide_to_muscle(Pose::Identity(), 96).has_value());
  // the block is 160 mm wide: no muscle below this face of 38 mm, and all of it only 40 mm back
  const auto slid = finder.slide_to_muscle(Pose(Eigen::Translation3d(95e-3, 0, 0)), 96);
  ASSERT_TRUE(slid.has_value());
  EXPECT_NEAR(slid->translation().x(), 55e-3, 1e-9);
}

TEST(EchoPatch, ReadsTheRangeAndRefusesATableWithoutIt) {
  const fs::path file = fs::temp_directory_path() / "artus-patch-range.tsv";
  std::ofstream(file) << "file\tmean\tstd\tacf_fwhm_axial_px\tacf_fwhm_lateral_px\n"
                      << "d1.png\t50\t30\t4\t12\nBone.png\t90\t40\t6\t20\nSpine.png\t1\t1\t1\t1\n";
  const std::vector<std::string> rows{"d", "Bone"};
  const auto range = read_patch_range(file, rows);
  ASSERT_TRUE(range.has_value());
  EXPECT_EQ(read_patch_range(file)->images, 3U);
  EXPECT_EQ(read_patch_range(file, std::vector<std::string>{"Skin"}).error().code,
            ErrorCode::malformed);
  EXPECT_EQ(range->images, 2U);
  EXPECT_EQ(range->least.mean, 50);
  EXPECT_EQ(range->most.lateral_width, 20);
  std::ofstream(file) << "file\tmean\nd1.png\t50\n";
  EXPECT_EQ(read_patch_range(file).error().code, ErrorCode::malformed);
  std::ofstream(file) << "file\tmean\n";
  EXPECT_EQ(read_patch_range(file).error().code, ErrorCode::malformed);
  fs::remove(file);
  EXPECT_EQ(read_patch_range(file).error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace artus
