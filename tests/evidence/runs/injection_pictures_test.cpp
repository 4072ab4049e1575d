// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_pictures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <opencv2/videoio.hpp>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/evidence/runs/injection_report.h"
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
  auto run = run_injection(*scene, spec);
  ASSERT_TRUE(run) << run.error().message;
  InjectionPictureOptions options;
  options.transducer.n_lines = 48;
  options.settings.depth = 16e-3;
  options.settings.n_planes = 1;

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

TEST_F(InjectionVideo, PicturesSayHowWideAndThickTheLiquidIsWhateverTheBeamsSlant) {
  const std::vector<SphereLayer> layers{
      {"skin", 46e-3}, {"muscle", 44e-3}, {"bursa", 32e-3}, {"tendon", 30e-3}, {"bone", 24e-3}};
  InjectionSpec spec;
  spec.entry = Vec3(0, 0, -46e-3);
  spec.target = Vec3(0, 0, -31e-3);
  spec.volume = 3e-6;
  spec.rate = 0.5e-6;
  spec.aspirate = 0;
  InjectionPictureOptions options;
  options.transducer.n_lines = 48;
  options.settings.depth = 30e-3;
  std::vector<InjectionPictures> seen;
  for (const double degrees : {0.0, 15.0}) {
    CompiledJoint joint = test::make_nested_spheres(layers, Vec3::Zero(), 5);
    const double slant = degrees * std::numbers::pi / 180;
    const Vec3 look(std::sin(slant), 0, std::cos(slant));
    joint.X_JP_default = make_pose(-46e-3 * look, look, Vec3(std::cos(slant), 0, -std::sin(slant)));
    const auto scene = std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(joint));
    const auto run = run_injection(*scene, spec);
    ASSERT_TRUE(run) << run.error().message;
    const auto pictures = write_injection_pictures(scene, *run, options, folder_);
    ASSERT_TRUE(pictures) << pictures.error().message;
    for (const Claim& claim : claims_of(*pictures)) EXPECT_TRUE(claim.pass) << to_line(claim);
    EXPECT_GT(pictures->opening, 2e-3);
    EXPECT_NEAR(pictures->label_volume, run->given, 0.05 * run->given);
    EXPECT_NEAR(pictures->seen_opening, pictures->opening, 0.1 * pictures->opening) << degrees;
    seen.push_back(*pictures);
  }
  EXPECT_NEAR(seen[0].seen_width, seen[1].seen_width, 0.1 * seen[0].seen_width);
}

TEST(InjectionPictures,
     ABursaWiderOrThickerThanPublishedIsToldWhetherItIsConfinedOrNotAndFailsNoInjection) {
  const auto failed = [](double given, double opening, double width, bool confined) {
    InjectionRun run;
    run.target_like = "bursa";
    run.given = given;
    InjectionPictures pictures;
    pictures.opening = opening;
    pictures.seen_width = width;
    pictures.confined = confined;
    EXPECT_TRUE(claims_of(pictures).empty());
    const auto claims = compare_with_published(run, pictures);
    return std::pair(claims.size(), std::count_if(claims.begin(), claims.end(),
                                                  [](const Claim& c) { return !c.pass; }));
  };
  for (const bool confined : {false, true}) {
    EXPECT_EQ(failed(5e-6, 5.9e-3, 29e-3, confined), std::pair(std::size_t{2}, std::ptrdiff_t{0}));
    EXPECT_EQ(failed(5e-6, 5.9e-3, 32e-3, confined).second, 1);
    EXPECT_EQ(failed(5e-6, 10e-3, 73e-3, confined).second, 2);
  }
  EXPECT_EQ(failed(1e-6, 1e-3, 20e-3, false).first, 0U) << "published for 5 ml alone";
  EXPECT_EQ(failed(5e-6, 4e-3, 0, false).first, 1U) << "no width is seen by a curved probe";
}

}  // namespace
}  // namespace artus
