// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/picture_plate.h"

#include <array>
#include <filesystem>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class PicturePlate : public test::TemporaryFolder {};

TEST_F(PicturePlate, HasEachPictureAtItsOwnSizeBesideTheOther) {
  cv::imwrite((folder_ / "a.png").string(), cv::Mat(20, 40, CV_8UC3, cv::Scalar(10, 20, 30)));
  cv::imwrite((folder_ / "b.png").string(), cv::Mat(50, 30, CV_8UC3, cv::Scalar(40, 50, 60)));
  const std::array<std::filesystem::path, 2> files{folder_ / "a.png", folder_ / "b.png"};
  const std::array<std::string, 2> names{"one", "other"};
  ASSERT_TRUE(write_plate(files, names, folder_ / "plate.png"));
  const cv::Mat plate = cv::imread((folder_ / "plate.png").string());
  EXPECT_GE(plate.cols, 70);
  EXPECT_GE(plate.rows, 50);
  const auto pixels_of = [&](const cv::Scalar& colour) {
    cv::Mat is;
    cv::inRange(plate, colour, colour, is);
    return cv::countNonZero(is);
  };
  EXPECT_EQ(pixels_of({10, 20, 30}), 20 * 40);
  EXPECT_EQ(pixels_of({40, 50, 60}), 50 * 30);
}

TEST_F(PicturePlate, NamesAPictureThatIsNotThere) {
  const std::array<std::filesystem::path, 1> files{folder_ / "none.png"};
  const std::array<std::string, 1> names{"none"};
  const auto written = write_plate(files, names, folder_ / "plate.png");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().where.find("none.png"), std::string::npos);
}

}  // namespace
}  // namespace artus
