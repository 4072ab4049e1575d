// SPDX-License-Identifier: AGPL-3.0-or-later
// The B-mode goldens notice what a sonographer sees: each change below, made on a copy of the
// golden, is told by the measure that is meant for it, and the golden itself by none.
#include "tests/golden/picture_difference.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <ostream>
#include <string>
#include <tuple>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "tests/support/paths.h"

namespace artus::test {
namespace {

const std::filesystem::path kExpected = source_dir() / "tests/golden/expected";
constexpr double kGreysOfADecibel = 255.0 / 60;

struct Golden {
  cv::Mat image;
  Landmarks marks;
};

Golden read_golden(const std::string& name) {
  const auto json = nlohmann::json::parse(std::ifstream(kExpected / (name + ".json")));
  return {cv::imread((kExpected / (name + ".png")).string(), cv::IMREAD_GRAYSCALE),
          landmarks_from(json.at("landmarks"))};
}

nlohmann::json tolerance() {
  return nlohmann::json::parse(std::ifstream(kExpected / "bmode.json")).at("tolerance");
}

int bone_row(const Landmarks& marks, int column) {
  return marks.bone.at(static_cast<std::size_t>(column / marks.bone_step));
}

/// Adds greys to what the golden shows between two depths above the bone, from column to column.
void add_above_bone(Golden& golden, int above, int below, cv::Range columns, double greys) {
  for (int x = columns.start; x < columns.end; ++x) {
    const int bone = bone_row(golden.marks, x);
    if (bone < 0) continue;
    for (int y = std::max(0, bone - above); y < std::min(golden.image.rows, bone - below); ++y) {
      auto& grey = golden.image.at<std::uint8_t>(y, x);
      if (grey > 0) grey = cv::saturate_cast<std::uint8_t>(grey + greys);
    }
  }
}

void shift_by(Golden& golden, double right_mm, double down_mm) {
  const cv::Mat move = (cv::Mat_<double>(2, 3) << 1, 0, right_mm / golden.marks.pixel_mm, 0, 1,
                        down_mm / golden.marks.pixel_mm);
  const cv::Mat before = golden.image.clone();
  cv::warpAffine(before, golden.image, move, before.size());
}

void weaken_bone(Golden& golden) {
  add_above_bone(golden, 9, -9, {180, 230}, -kGreysOfADecibel);
}

void brighten_tendon(Golden& golden) {
  add_above_bone(golden, 75, 30, {0, golden.image.cols}, 2 * kGreysOfADecibel);
}

/// What lies 1.5 mm below the needle takes its place.
void remove_needle(Golden& golden) {
  const cv::Mat before = golden.image.clone();
  const cv::Point from = golden.marks.needle_in;
  const cv::Point to = golden.marks.needle_to;
  for (int x = std::min(from.x, to.x); x <= std::max(from.x, to.x); ++x) {
    const int row = from.y + (to.y - from.y) * (x - from.x) / std::max(1, to.x - from.x);
    for (int y = row - 7; y <= row + 7; ++y)
      if (y >= 0 && y + 15 < before.rows)
        golden.image.at<std::uint8_t>(y, x) = before.at<std::uint8_t>(y + 15, x);
  }
}

void roughen_speckle(Golden& golden) {
  cv::Mat smooth;
  cv::GaussianBlur(golden.image, smooth, {}, 10);
  cv::addWeighted(golden.image, 1.1, smooth, -0.1, 0, golden.image);
}

void move_right(Golden& golden) {
  shift_by(golden, 0.5, 0);
}

void move_down(Golden& golden) {
  shift_by(golden, 0, 0.5);
}

void light_up_shadow(Golden& golden) {
  for (int x = 150; x < 250; ++x)
    for (int y = bone_row(golden.marks, x) + 15; y < golden.image.rows; ++y) {
      auto& grey = golden.image.at<std::uint8_t>(y, x);
      grey = cv::saturate_cast<std::uint8_t>(grey + 2 * kGreysOfADecibel);
    }
}

struct Change {
  const char* name;
  void (*make)(Golden&);
  const char* told;
};
void PrintTo(const Change& change, std::ostream* out) {
  *out << change.name;
}

class VisibleChange : public testing::TestWithParam<std::tuple<const char*, Change>> {};

TEST_P(VisibleChange, IsTold) {
  const auto& [name, change] = GetParam();
  const Golden golden = read_golden(name);
  ASSERT_FALSE(golden.image.empty());
  Golden changed{golden.image.clone(), golden.marks};
  change.make(changed);
  const auto difference = compare_pictures(golden.image, changed.image, golden.marks);
  EXPECT_THAT(find_visible(difference, tolerance()),
              testing::Contains(testing::HasSubstr(change.told)))
      << to_text(difference);
}

INSTANTIATE_TEST_SUITE_P(
    Goldens, VisibleChange,
    testing::Combine(
        testing::Values("bmode-bursa-reached", "bmode-bone-touched"),
        testing::Values(Change{"BoneOneDecibelWeakerOver5mm", weaken_bone, "bone line"},
                        Change{"NeedleMissing", remove_needle, "needle line"},
                        Change{"SpeckleATenthRougher", roughen_speckle, "spread of a block"},
                        Change{"HalfAMillimetreAside", move_right, "shift"},
                        Change{"HalfAMillimetreDeeper", move_down, "depth of bone"},
                        Change{"TendonTwoDecibelBrighter", brighten_tendon, "mean of a block"},
                        Change{"GreyInTheShadow", light_up_shadow, "shadow of bone"})),
    [](const auto& parameter) {
      return std::string(std::get<1>(parameter.param).name) +
             (std::string(std::get<0>(parameter.param)) == "bmode-bursa-reached" ? "InBursaReached"
                                                                                 : "InBoneTouched");
    });

TEST(PictureDifference, OfAGoldenToItselfIsNothing) {
  for (const char* name : {"bmode-bursa-reached", "bmode-bone-touched"}) {
    const Golden golden = read_golden(name);
    EXPECT_THAT(
        find_visible(compare_pictures(golden.image, golden.image, golden.marks), tolerance()),
        testing::IsEmpty());
    EXPECT_GT(std::abs(golden.marks.needle_to.x - golden.marks.needle_in.x), 50);
    EXPECT_GT(bone_row(golden.marks, golden.image.cols / 2), 0);
  }
}

}  // namespace
}  // namespace artus::test
