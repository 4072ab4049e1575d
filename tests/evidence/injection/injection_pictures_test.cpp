// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/injection/injection_pictures.h"

#include <opencv2/videoio.hpp>

#include <gtest/gtest.h>

#include "artus/anatomy/body/space.h"
#include "artus/evidence/injection/injection_report.h"
#include "tests/support/layered_body.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class InjectionVideo : public test::TemporaryFolder {};

double mean_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total());
}

TEST_F(InjectionVideo, ShowsTheWholeCourseAndNoneOfARunThatGaveNothing) {
  const std::vector<FlatLayer> layers{{"skin", 2e-3}, {"muscle", 10e-3}, {"bone", 8e-3}};
  const auto scene = std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 60e-3, 60e-3)));
  InjectionSpec spec;
  spec.entry = Vec3::Zero();
  spec.target = Vec3(0, 0, 8e-3);
  spec.volume = 0.3e-6;
  spec.rate = 0.2e-6;
  spec.plunger.liquids = *read_bundled_liquids();
  spec.plunger.liquid = *find_liquid(spec.plunger.liquids, "saline");
  auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run) << run.error().message;
  InjectionPictureOptions options;
  options.transducer.n_lines = 48;
  options.settings.depth = 16e-3;

  const auto file = write_injection_video(scene, *run, options, folder_);
  ASSERT_TRUE(file) << file.error().message;
  cv::VideoCapture video(in(*file));
  std::vector<cv::Mat> pictures;
  for (cv::Mat picture; video.read(picture);) pictures.push_back(picture.clone());
  ASSERT_EQ(pictures.size(), 36U);
  EXPECT_GT(mean_difference(pictures.front(), pictures.back()),
            3 * mean_difference(pictures.front(), pictures[1]));

  std::erase_if(run->rows, [](const InjectionRow& row) { return row.phase == "inject"; });
  EXPECT_FALSE(write_injection_video(scene, *run, options, folder_));
}

}  // namespace
}  // namespace artus
