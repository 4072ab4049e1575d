// SPDX-License-Identifier: AGPL-3.0-or-later
// Cameras that mirror, hang, show nothing or give two pictures a second: no pose is made up.
#include "artus/detail/devices/kit/picture_check.h"

#include <random>

#include <opencv2/core.hpp>

#include <gtest/gtest.h>

#include "artus/detail/devices/kit/tracker.h"
#include "tests/kit/scenes.h"

namespace artus::kit {
namespace {

/// A scene in which all markers are seen.
struct PlainScene {
  PlainScene() : renderer(kit.lens) {
    std::mt19937_64 random(3);
    scene = test::make_scene(random, 0.45, 0.01);
  }
  [[nodiscard]] cv::Mat view(std::uint64_t picture) const {
    test::ViewFlaws flaws;
    flaws.hidden = 0;
    flaws.picture = picture;
    return renderer.render(test::bodies_of(scene, kit), flaws, 3);
  }
  Kit kit;
  test::KitScene scene;
  test::ViewRenderer renderer;
};

TEST(KitPictures, OfACameraThatMirrorsAreTurnedRound) {
  const PlainScene plain;
  const cv::Mat view = plain.view(0);
  cv::Mat mirrored;
  cv::flip(view, mirrored, 1);
  MirrorCheck check;
  const cv::Mat dark(view.size(), CV_8U, cv::Scalar(0));
  for (int k = 0; k < 40; ++k) EXPECT_EQ(check.right(dark).data, dark.data);
  EXPECT_FALSE(check.is_mirrored());
  EXPECT_EQ(cv::norm(check.right(mirrored), view, cv::NORM_INF), 0);
  EXPECT_TRUE(check.is_mirrored());
  EXPECT_EQ(cv::norm(check.right(mirrored), view, cv::NORM_INF), 0);

  MirrorCheck upright;
  for (int k = 0; k < 40; ++k) EXPECT_EQ(upright.right(view).data, view.data);
  EXPECT_FALSE(upright.is_mirrored());
}

TEST(KitPictures, OfACameraThatHangsAreNoNewOnes) {
  const PlainScene plain;
  FrozenCheck check;
  const cv::Mat first = plain.view(0);
  EXPECT_FALSE(check.is(first));
  EXPECT_FALSE(check.is(first));
  EXPECT_FALSE(check.is(first));
  EXPECT_TRUE(check.is(first));
  EXPECT_FALSE(check.is(plain.view(1))) << "the same scene with other noise";
}

TEST(KitPictures, NotesAreToldOnceForEachChange) {
  PictureNotes notes;
  EXPECT_EQ(notes.take(false, false), "");
  EXPECT_NE(notes.take(false, true), "");
  EXPECT_EQ(notes.take(false, true), "");
  EXPECT_EQ(notes.take(false, false), "");
  EXPECT_NE(notes.take(false, true), "");
  EXPECT_NE(notes.take(true, false), "");
  EXPECT_EQ(notes.take(true, false), "");
}

TEST(KitPictures, BlackOnesGiveNoPoseAndTwoASecondOneOfThreeAgreeing) {
  cv::setNumThreads(1);
  const PlainScene plain;
  Tracker tracker(plain.kit);
  const cv::Mat black(plain.view(0).size(), CV_8U, cv::Scalar(0));
  for (int k = 0; k < 5; ++k) {
    const HandsFrame frame = tracker.take(black, k / 30.0);
    EXPECT_FALSE(frame.X_SN || frame.X_SP || frame.X_PN || frame.sheet);
  }
  int given = 0;
  for (int k = 0; k < 7; ++k) {
    const HandsFrame frame = tracker.take(plain.view(static_cast<std::uint64_t>(k)), 1 + 0.5 * k);
    if (!frame.X_SN) continue;
    ++given;
    EXPECT_LT((frame.X_SN->translation() - plain.scene.X_SN.translation()).norm(), 5e-3);
  }
  EXPECT_EQ(given, 2) << "three that agree bring a hand back, and half a second loses it again";
}

}  // namespace
}  // namespace artus::kit
