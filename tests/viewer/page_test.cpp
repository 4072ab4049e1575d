// SPDX-License-Identifier: AGPL-3.0-or-later
// Pages and reviews without a screen: what an action does, whose steps a script's are, where one
// stands in a film, and what sets a probe right.
#include "artus/detail/viewer/pages/page.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/pages/review.h"
#include "artus/detail/viewer/panels/lesson.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

TEST(Page, TheMarkStopsAtTheEndsAndAnEmptyPageChoosesNothing) {
  EXPECT_EQ(move_on_page(Action::down, 0, 3).at, 1U);
  EXPECT_EQ(move_on_page(Action::down, 2, 3).at, 2U);
  EXPECT_EQ(move_on_page(Action::up, 0, 3).at, 0U);
  EXPECT_TRUE(move_on_page(Action::accept, 1, 3).chosen);
  EXPECT_FALSE(move_on_page(Action::accept, 0, 0).chosen);
  EXPECT_TRUE(move_on_page(Action::let_go, 1, 3).back);
  EXPECT_FALSE(move_on_page(Action::push, 1, 3).chosen);
}

TEST(Page, AGamepadsButtonsChooseAndGoBack) {
  EXPECT_TRUE(move_on_page(Action::choose_entry, 1, 3).chosen);
  EXPECT_TRUE(move_on_page(Action::explore, 1, 3).back);
}

TEST(PageScript, EachPageTakesItsOwnStepsInOrder) {
  const auto steps = parse_script(
      "page who\nkey ENTER\nkey DOWN\npage attempt\nawait inside 5\npage who\n", "test");
  ASSERT_TRUE(steps) << steps.error().to_string();
  PageScript script(*steps);
  EXPECT_TRUE(script.given());
  EXPECT_EQ(script.take("who")->size(), 2U);
  const auto other = script.take("review");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("'review'"), std::string::npos);
  EXPECT_NE(other.error().message.find("'attempt'"), std::string::npos);
  EXPECT_EQ(script.take("attempt")->size(), 1U);
  EXPECT_FALSE(script.over());
  EXPECT_TRUE(script.take("who")->empty());
  EXPECT_TRUE(script.over());
}

TEST(PageScript, WithoutAScriptNobodyHasStepsAndWrongOnesAreRefused) {
  PageScript none;
  EXPECT_FALSE(none.given());
  EXPECT_TRUE(none.take("who")->empty());
  EXPECT_FALSE(parse_script("await nothing 3\n", "test"));
  EXPECT_FALSE(parse_script("await inside 0\n", "test"));
  EXPECT_FALSE(parse_script("page\n", "test"));
  auto steps = parse_script("key ENTER\npage who\n", "test");
  ASSERT_TRUE(steps);
  EXPECT_FALSE(PageScript(*steps).take("who")) << "steps before the first page are nobody's";
}

TEST(ReviewCursor, GoesFromFaultToFaultInOrderOfTimeAndStaysInTheFilm) {
  ReviewCursor cursor(10, {7, 2, 5});
  cursor.earlier_fault();
  EXPECT_EQ(cursor.time(), 0) << "there is none before";
  cursor.later_fault();
  EXPECT_EQ(cursor.time(), 2);
  EXPECT_EQ(cursor.near(), std::optional<std::size_t>(1));
  cursor.later_fault();
  cursor.later_fault();
  EXPECT_EQ(cursor.time(), 7);
  cursor.later_fault();
  EXPECT_EQ(cursor.time(), 7) << "nor behind the last";
  cursor.earlier_fault();
  EXPECT_EQ(cursor.time(), 5);
  cursor.go_to(99);
  EXPECT_EQ(cursor.time(), 10);
  EXPECT_FALSE(cursor.near()) << "3 s from the next fault";
}

TEST(ReviewCursor, PlaysToTheEndAndBeginsAgainFromThere) {
  ReviewCursor cursor(3, {});
  cursor.pass(1);
  EXPECT_EQ(cursor.time(), 0) << "it stands";
  cursor.play(true);
  cursor.pass(2);
  EXPECT_EQ(cursor.time(), 2);
  cursor.pass(2);
  EXPECT_EQ(cursor.time(), 3);
  EXPECT_FALSE(cursor.playing());
  cursor.play(true);
  EXPECT_EQ(cursor.time(), 0);
}

TEST(ReviewFilm, TellsTheMomentAtATimeAndWhenTheNeedleWentIn) {
  ReviewFilm film;
  EXPECT_EQ(film.length(), 0);
  for (int i = 0; i < 5; ++i) {
    ReviewMoment moment;
    moment.time = 0.5 * i;
    moment.state.inserted = i >= 3 ? 1 : 0;
    film.moments.push_back(moment);
  }
  EXPECT_EQ(film.length(), 2);
  EXPECT_EQ(film.contact(), 1.5);
  EXPECT_EQ(film.at(-1).time, 0);
  EXPECT_EQ(film.at(1.2).time, 1);
  EXPECT_EQ(film.at(1.5).time, 1.5);
  EXPECT_EQ(film.at(99).time, 2);
}

/// A needle in a block, 20 degrees flat, turned by `turn` about the beam and `beside` off the
/// plane.
Pose needle_at(double turn, double beside) {
  const Vec3 along(std::cos(20 * kDegree) * std::cos(turn), std::cos(20 * kDegree) * std::sin(turn),
                   std::sin(20 * kDegree));
  return make_pose(Vec3(0, beside, 10e-3), along, Vec3::Zero());
}

TEST(MendProbe, BringsShaftAndTipIntoThePlaneWhereverTheProbeStood) {
  const auto scene = test::make_layered_scene();
  const Pose X_JP = make_pose(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX());
  for (const double turn : {-30 * kDegree, -4 * kDegree, 0.0, 12 * kDegree}) {
    for (const double beside : {-3e-3, 0.0, 5e-3}) {
      const Pose X_JN = needle_at(turn, beside);
      const auto mended = mend_probe(*scene, X_JP, X_JN);
      ASSERT_TRUE(mended) << turn << ' ' << beside;
      EXPECT_NEAR(mended->turned, turn, 1e-9);
      const Pose X_PN = mended->X_JP.inverse() * X_JN;
      EXPECT_NEAR(X_PN.translation().y(), 0, 1e-9);
      EXPECT_NEAR(X_PN.linear().col(2).y(), 0, 1e-9);
      EXPECT_NEAR(mended->X_JP.translation().z(), 0, 1e-6) << "the face stays on the skin";
    }
  }
}

TEST(MendProbe, ANeedleThatIsMeantToCrossThePlaneIsNotMended) {
  const auto scene = test::make_layered_scene();
  const Pose X_JP = make_pose(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX());
  EXPECT_FALSE(mend_probe(*scene, X_JP, needle_at(80 * kDegree, 0))) << "out of plane";
  const Pose upright = make_pose(Vec3(0, 0, 10e-3), Vec3::UnitZ(), Vec3::Zero());
  EXPECT_FALSE(mend_probe(*scene, X_JP, upright)) << "no plane is its own";
}

TEST(Lesson, WhatOnlyTheTruthTellsIsNotToldWithoutAids) {
  NeedleReading truth;
  truth.inside = true;
  truth.depth = 12e-3;
  truth.layer = "bursa";
  truth.region = 5;
  truth.on_bone = true;
  truth.to_target = 3e-3;
  truth.plane_offset = 2e-3;
  const NeedleReading told = seen_from_outside(truth);
  EXPECT_TRUE(told.inside) << "everyone sees that";
  EXPECT_EQ(told.depth, truth.depth) << "and how much of the shaft is left";
  EXPECT_TRUE(told.layer.empty());
  EXPECT_EQ(told.region, kOutside);
  EXPECT_FALSE(told.on_bone);
  EXPECT_EQ(told.to_target, 0);
  EXPECT_EQ(told.plane_offset, 0);
}

TEST(Lesson, APointLiesOnThePictureByItsPlaceBeforeTheProbe) {
  ImageSnapshot image;
  image.width = 400;
  image.height = 300;
  image.pixel = 0.1e-3;
  image.input.X_JP = to_plain(make_pose(Vec3(0.1, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  const ImagePoint p = point_on_picture(image, Vec3(0.105, 7e-3, 12e-3));
  EXPECT_NEAR(p.x_mm, 25, 1e-9) << "5 mm right of the middle of 40 mm";
  EXPECT_NEAR(p.y_mm, 12, 1e-9);
  EXPECT_FALSE(LessonAids{}.any());
}

}  // namespace
}  // namespace artus
