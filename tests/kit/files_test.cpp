// SPDX-License-Identifier: AGPL-3.0-or-later
// What the kit reads and writes beside its own file: sheets, parts, pictures, messages.
#include <cmath>
#include <fstream>

#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/devices/kit/picture_source.h"
#include "artus/detail/devices/kit/pose_sender.h"
#include "artus/detail/devices/kit/sheets.h"
#include "artus/detail/devices/kit/solid.h"
#include "artus/detail/exchange/igtl/contents.h"
#include "tests/support/temporary_folder.h"

namespace artus::kit {
namespace {

class KitFiles : public test::TemporaryFolder {};

/// What a page is wide and high, points: the last MediaBox of the file.
std::pair<double, double> page_of(const std::string& pdf) {
  const std::size_t at = pdf.find("/MediaBox");
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
  if (at != std::string::npos)
    std::sscanf(pdf.c_str() + pdf.find('[', at), "[ %lf %lf %lf %lf", &x, &y, &width, &height);
  return {width, height};
}

TEST_F(KitFiles, SheetsAreOfTheirPaperAndHaveARulerOfAHundredMillimetres) {
  ASSERT_TRUE(write_sheets(folder_, Paper::a4, Hand::right));
  for (const char* name : {"markers.pdf", "sheet.pdf", "board.pdf"}) {
    const auto pdf = read_bytes(folder_ / name);
    ASSERT_TRUE(pdf) << name;
    EXPECT_EQ(pdf->substr(0, 5), "%PDF-");
    const auto [width, height] = page_of(*pdf);
    EXPECT_NEAR(width * 25.4 / 72, 297, 0.1) << name;
    EXPECT_NEAR(height * 25.4 / 72, 210, 0.1) << name;
    // The ruler is the one horizontal line of its length: "x y m" and then "x+283.46 y l".
    double from = 0;
    double y = 0;
    double to = 0;
    double same = 0;
    bool ruler = false;
    std::size_t at = 0;
    while ((at = pdf->find(" m\n", at)) != std::string::npos) {
      const std::size_t line = pdf->rfind('\n', at - 1) + 1;
      if (std::sscanf(pdf->c_str() + line, "%lf %lf m\n%lf %lf l", &from, &y, &to, &same) == 4)
        ruler = ruler || (y == same && std::abs((to - from) * 25.4 / 72 - 100) < 0.02);
      ++at;
    }
    EXPECT_TRUE(ruler) << name;
  }
  ASSERT_TRUE(write_sheets(folder_ / "us", Paper::letter, Hand::left));
  const auto letter = read_bytes(folder_ / "us" / "sheet.pdf");
  EXPECT_NEAR(page_of(*letter).first, 792, 0.5);
  EXPECT_FALSE(write_sheets("/proc/nowhere", Paper::a4, Hand::right));
}

TEST_F(KitFiles, PartsAreWrittenInMillimetres) {
  ASSERT_TRUE(write_parts(folder_, Hand::right, 15.8e-3));
  const auto mock = read_surface(folder_ / "probe.stl", 1e-3);
  ASSERT_TRUE(mock) << mock.error().to_string();
  EXPECT_NEAR(signed_volume(*mock), signed_volume(make_probe_mock(Hand::right)), 1e-9);
}

TEST_F(KitFiles, AFolderIsACameraWithTheTimesOfItsNames) {
  EXPECT_DOUBLE_EQ(*time_of_name("hand_0033ms.png"), 0.033);
  EXPECT_DOUBLE_EQ(*time_of_name("12500us.jpg"), 0.0125);
  EXPECT_FALSE(time_of_name("0001.png"));
  const cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(90));
  for (const char* name : {"a_0000ms.png", "a_0040ms.png", "a_0100ms.png"})
    cv::imwrite(in(name), grey);
  auto source = open_pictures(folder_.string(), {});
  ASSERT_TRUE(source) << source.error().to_string();
  EXPECT_FALSE((*source)->is_live());
  for (const double time : {0.0, 0.04, 0.1}) {
    const auto picture = (*source)->next();
    ASSERT_TRUE(picture && *picture);
    EXPECT_DOUBLE_EQ((*picture)->time, time);
    EXPECT_EQ((*picture)->grey.cols, 64);
  }
  EXPECT_FALSE((*source)->next()->has_value());
  cv::imwrite(in("b_0200ms.png"), cv::Mat(10, 10, CV_8UC1, cv::Scalar(0)));
  auto other = open_pictures(folder_.string(), {});
  for (int k = 0; k < 3; ++k) ASSERT_TRUE((*other)->next());
  const auto odd = (*other)->next();
  ASSERT_FALSE(odd);
  EXPECT_NE(odd.error().message.find("10 x 10"), std::string::npos);
}

TEST_F(KitFiles, WhatIsNoCameraIsRefused) {
  EXPECT_FALSE(open_pictures("webcam:first", {}));
  EXPECT_FALSE(open_pictures("webcam:63", {})) << "no such camera here";
  EXPECT_FALSE(open_pictures(in("nothing.mp4"), {}));
  EXPECT_FALSE(open_pictures(folder_.string(), {})) << "an empty folder";
  std::ofstream(in("text.mp4")) << "no video";
  EXPECT_FALSE(open_pictures(in("text.mp4"), {}));
}

TEST(KitMessages, OfAFrameAreOfTheBlocksTopInMillimetresAndOfItsTime) {
  HandsFrame frame;
  frame.time = 1.75e9 + 0.5;
  EXPECT_TRUE(messages_of(frame, 0.05).empty()) << "what was not seen is not sent";
  frame.X_SN = make_pose(Vec3(0.01, -0.02, 0.08), -Vec3::UnitZ(), Vec3::UnitX());
  frame.plunger = 0.012;
  const auto messages = messages_of(frame, 0.05);
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].device, "NeedleToReference");
  EXPECT_NEAR(igtl::seconds_of(messages[0].time), frame.time, 1e-6);
  const auto matrix = igtl::parse_transform(messages[0].content);
  ASSERT_TRUE(matrix);
  EXPECT_NEAR((matrix->col(3) - Vec3(10, -20, 30)).norm(), 0, 1e-4);
  const auto sensor = igtl::parse_sensor(messages[1].content);
  ASSERT_TRUE(sensor);
  EXPECT_EQ(sensor->unit, igtl::kMetre);
  EXPECT_DOUBLE_EQ(sensor->values[0], 0.012);
}

TEST(KitMessages, GoOutToWhoListensAndComeBackTheSame) {
  auto sender = PoseSender::open("", "127.0.0.1:0");
  ASSERT_TRUE(sender) << sender.error().to_string();
  EXPECT_GT(sender->port(), 0);
  EXPECT_EQ(sender->peers(), 0U);
  EXPECT_FALSE(PoseSender::open("nonsense:port", ""));
}

}  // namespace
}  // namespace artus::kit
