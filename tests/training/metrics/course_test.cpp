// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/training/metrics/closed_body.h"
#include "artus/detail/training/metrics/force_layers.h"
#include "artus/detail/training/metrics/goals.h"
#include "artus/detail/training/metrics/needle_course.h"
#include "artus/detail/training/metrics/sight_course.h"
#include "tests/session/session_support.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

/// The course along depths (mm) at 20 Hz, each reached in `n` even steps from the one before.
std::vector<CoursePoint> course_of(std::initializer_list<double> depths, int n) {
  std::vector<CoursePoint> course;
  double last = *depths.begin();
  for (const double goal : depths) {
    for (int k = 1; k <= n; ++k) {
      CoursePoint p;
      p.time = 0.05 * static_cast<double>(course.size());
      p.depth = std::max(0.0, 1e-3 * (last + (goal - last) * k / n));
      p.tip = Vec3(0, 0, p.depth);
      p.region = p.depth > 0 ? kFirstRegion : kOutside;
      if (!course.empty()) {
        p.step = std::abs(p.depth - course.back().depth);
        p.advance = p.depth - course.back().depth;
      }
      course.push_back(p);
    }
    last = goal;
  }
  return course;
}

TEST(Course, PassesFollowWithdrawalsOfFiveMillimetres) {
  EXPECT_EQ(find_passes(course_of({-5, 30, 0, -5}, 50)).size(), 1U);
  EXPECT_EQ(find_passes(course_of({-5, 30, 26, 35}, 50)).size(), 1U);
  EXPECT_EQ(find_passes(course_of({-5, 30, 24, 32}, 50)).size(), 2U);
  EXPECT_EQ(find_passes(course_of({-5, 30, 24, 28, 10, 30}, 50)).size(), 2U);
  EXPECT_EQ(find_passes(course_of({-5, -1}, 50)).size(), 0U);
}

TEST(Course, NoTimeInTissueIsLongerThanTheTime) {
  const CourseTotals sum = sum_course(course_of({-5, 30, 30}, 50));
  ASSERT_TRUE(sum.entered && sum.last_inside);
  EXPECT_NEAR(sum.time_in_tissue, *sum.last_inside - *sum.entered, 1e-12);
}

TEST(Course, IdleIsInsideAndLongerThanThreeSeconds) {
  EXPECT_EQ(find_idle(course_of({-5, 20, 20, 30}, 62)).size(), 1U);
  EXPECT_EQ(find_idle(course_of({-5, 20, 20, 30}, 58)).size(), 0U);
  EXPECT_EQ(find_idle(course_of({-5, -5, -5}, 100)).size(), 0U);
}

TEST(Course, WhoSweepsTheProbeIsNotIdle) {
  const auto course = course_of({-5, 20, 20, 30}, 200);  // ten seconds of rest
  std::vector<TrackPoint> probe;
  for (const CoursePoint& at : course) {
    TrackPoint p;
    p.time = at.time;
    probe.push_back(p);
  }
  EXPECT_EQ(find_idle(course, probe).size(), 1U);
  for (std::size_t i = 0; i < probe.size(); ++i) probe[i].p.x() = 5e-3 * probe[i].time;
  EXPECT_EQ(find_idle(course, probe).size(), 0U);
  for (std::size_t i = 0; i < probe.size(); ++i) {
    probe[i].p.setZero();
    probe[i].q = Eigen::AngleAxisd(0.1 * probe[i].time, Vec3::UnitX());
  }
  EXPECT_EQ(find_idle(course, probe).size(), 0U);
}

TEST(Course, ARunUnseenIsItsAdvancesNotItsRests) {
  const auto course = course_of({-5, 4, 4, 8, 8, 8, 10}, 80);  // 4 s each
  std::vector<std::optional<TipSight>> sights(course.size());
  for (std::size_t i = 0; i < course.size(); ++i) {
    sights[i] = TipSight{};
    sights[i]->in_picture = true;
    sights[i]->loss = SightLoss::off_plane;
  }
  const SightTotals sum = sum_sight(course, sights);
  ASSERT_EQ(sum.unseen.size(), 3U);
  double shaded = 0;
  for (const auto& run : sum.unseen) shaded += run.to - run.from;
  EXPECT_NEAR(shaded, 4.0 * 4 / 9 + 4 + 4, 0.3);
  EXPECT_EQ(sum.unseen_advances, 3);
}

TEST(Course, ABlindAdvanceIsMoreThanOne) {
  for (const auto& [depth, advances] : {std::pair{4.0, 1}, {9.0, 2}, {50.5, 11}}) {
    const auto course = course_of({-5, depth}, 200);
    std::vector<std::optional<TipSight>> sights(course.size());
    for (auto& sight : sights) {
      sight = TipSight{};
      sight->loss = SightLoss::off_plane;
    }
    EXPECT_EQ(sum_sight(course, sights).unseen_advances, advances) << depth;
  }
}

TEST(Course, TheWayToThePicturesEdgeIsOneAdvance) {
  const auto course = course_of({-5, 20}, 200);
  std::vector<std::optional<TipSight>> sights(course.size());
  for (std::size_t i = 0; i < course.size(); ++i) {
    sights[i] = TipSight{};
    sights[i]->in_picture = course[i].depth > 15e-3;
    sights[i]->loss = course[i].depth > 16e-3 ? SightLoss::none : SightLoss::off_sector;
  }
  const SightTotals sum = sum_sight(course, sights);
  EXPECT_EQ(sum.unseen_advances, 1);
  EXPECT_NEAR(sum.outside_picture, 15e-3, 0.3e-3);
}

TEST(Course, WhatThePicturesShowIsSeenAndNothingElse) {
  const auto course = course_of({-5, 20, 20, 20}, 100);
  std::vector<std::optional<TipSight>> sights(course.size(), TipSight{});
  sights[150]->loss = SightLoss::off_plane;  // geometry says no, the picture yes
  std::vector<ImageSight> images;
  for (const double time : {7.45, 7.5, 7.55}) images.push_back({time, true, 9.0});
  for (const double time : {10.0, 10.05, 10.1}) images.push_back({time, false, 2.0});
  images.push_back({12, false, std::nullopt});
  look_at_pictures(course, images, sights);
  EXPECT_TRUE(sights[150]->seen());
  EXPECT_FALSE(sights[201]->seen());  // whatever geometry says
  EXPECT_FALSE(sights[240]->seen());  // nothing of the tip shows
  sights[150]->tip_db = TipSight::kHeard - 1;
  EXPECT_FALSE(sights[150]->seen()) << "what is bright there is not the tip";
  EXPECT_TRUE(sights[20]->seen());  // no picture: geometry
  EXPECT_FALSE(sights[20]->shown_db);
}

TEST(Course, MovementsLastAFifthOfASecond) {
  const auto count = [](std::initializer_list<std::pair<double, int>> runs) {
    std::vector<double> speeds;
    for (const auto& [speed, n] : runs)
      speeds.insert(speeds.end(), static_cast<std::size_t>(n), speed);
    return count_movements(speeds, 0.05, 0.2);
  };
  EXPECT_EQ(count({{0, 10}, {0.06, 4}, {0, 10}}), 1);
  EXPECT_EQ(count({{0, 10}, {0.06, 3}, {0, 10}}), 0);
  EXPECT_EQ(count({{0.06, 6}, {0, 3}, {0.06, 6}}), 1);
  EXPECT_EQ(count({{0.06, 6}, {0, 4}, {0.06, 6}}), 2);
}

TEST(Course, ATipBesideACutBodyIsOutsideUnlessItsShaftCameThroughTheSkin) {
  CompiledJoint joint = *test::make_layered_scene()->shared_joint();
  for (Interface& face : joint.mesh.interfaces) {
    const bool top = std::all_of(face.vertices.begin(), face.vertices.end(),
                                 [&](std::uint32_t v) { return joint.mesh.vertices[v].z() == 0; });
    if (!top && face.front == kOutside) face.front = kBeyond;
  }
  const Scene cut(std::make_shared<const CompiledJoint>(std::move(joint)));
  constexpr double kBeside = 0.2;  // m from the block's middle
  const Vec3 beside(kBeside, 0, 0.01);
  const Vec3 below(0, 0, kBeside);
  ASSERT_EQ(cut.region_at(beside), kBeyond);
  EXPECT_EQ(region_of_tip(cut, beside, Vec3::UnitZ()), kOutside);
  EXPECT_EQ(region_of_tip(cut, below, Vec3::UnitZ()), kBeyond);
}

TEST(Course, TotalsOfARealBlock) {
  const auto scene = test::make_layered_scene();
  std::vector<TrackPoint> track;
  for (int i = 0; i <= 100; ++i) {
    TrackPoint p;
    p.time = 0.05 * i;
    p.p = Vec3(0, 0, -5e-3 + 0.25e-3 * i);
    track.push_back(p);
  }
  const auto course = make_course(*scene, track);
  const CourseTotals sum = sum_course(course);
  EXPECT_NEAR(sum.path, 25e-3, 1e-12);
  EXPECT_NEAR(sum.deepest, 20e-3, 1e-9);
  EXPECT_NEAR(sum.advanced, 20e-3, 0.26e-3);
  EXPECT_NEAR(sum.swept_area, 0, 1e-15);
  ASSERT_TRUE(sum.first_contact);
  EXPECT_NEAR(*sum.first_contact, 1, 0.051);
}

TEST(Course, RedirectionsAreTurnsBetweenRests) {
  const auto scene = test::make_layered_scene();
  std::vector<TrackPoint> track;
  const auto rest = [&](double angle, int n) {
    for (int i = 0; i < n; ++i) {
      TrackPoint p;
      p.time = 0.05 * static_cast<double>(track.size());
      p.q = Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitY()));
      p.p = Vec3(0, 0, 10e-3);
      track.push_back(p);
    }
  };
  rest(0, 20);
  rest(0.08, 20);
  EXPECT_EQ(find_redirections(make_course(*scene, track)).size(), 0U);
  rest(0.2, 20);
  EXPECT_EQ(find_redirections(make_course(*scene, track)).size(), 1U);
}

TEST(Course, APassBeginsWhereTheNeedleTurnsHoweverLongItRestsThere) {
  const auto course = course_of({-5, 30, 10, 10, 10, 30}, 50);  // 2.5 s each
  const auto passes = find_passes(course);
  ASSERT_EQ(passes.size(), 2U);
  EXPECT_NEAR(passes[1], 12.5, 0.15);
}

TEST(Course, OneSlowTurnIsOneRedirection) {
  const auto scene = test::make_layered_scene();
  for (const double rate : {3.0, 10.0}) {  // degrees a second about the tip
    std::vector<TrackPoint> track;
    const auto add = [&](double angle) {
      TrackPoint p;
      p.time = 0.05 * static_cast<double>(track.size());
      p.q = Eigen::Quaterniond(Eigen::AngleAxisd(angle * kDegree, Vec3::UnitY()));
      p.p = Vec3(0, 0, 10e-3);
      track.push_back(p);
    };
    for (int i = 0; i < 40; ++i) add(0);
    for (double angle = 0; angle < 24; angle += 0.05 * rate) add(angle);
    for (int i = 0; i < 40; ++i) add(24);
    EXPECT_EQ(find_redirections(make_course(*scene, track)).size(), 1U) << rate;
  }
}

TEST(Course, ALongTurnAtRestIsOneRedirection) {
  std::vector<CoursePoint> course = course_of({10, 10}, 300);  // 30 s
  const auto turn = [&](double degrees, std::size_t from, std::size_t n) {
    for (std::size_t i = from; i < course.size(); ++i) {
      const double part = std::min(1.0, static_cast<double>(i - from) / static_cast<double>(n));
      const double now = degrees * part * 3.141592653589793 / 180;
      course[i].axis = Eigen::AngleAxisd(now, Vec3::UnitY()) * course[i].axis;
    }
  };
  turn(23, 100, 60);  // 8 degrees a second
  EXPECT_EQ(find_redirections(course).size(), 1U);
  turn(-23, 200, 60);
  EXPECT_EQ(find_redirections(course).size(), 2U);
  turn(23, 300, 20);
  turn(-23, 325, 20);  // there and back with hardly a rest
  EXPECT_EQ(find_redirections(course).size(), 3U);
}

TEST(Goals, IntrusionsAreMeasuredFromTheZonesEdge) {
  const auto scene = test::make_layered_scene();  // tendon from 24 to 29 mm
  const AvoidZone zone{"tendon",
                       make_region_body(scene->joint(), region_named(scene->joint(), "tendon")),
                       2e-3, true};
  const Intrusion in = find_intrusion(zone, course_of({-5, 25, 0, 23, 0}, 100));
  EXPECT_NEAR(in.depth, 3e-3, 1e-9);
  EXPECT_EQ(in.entries, 2);
  EXPECT_EQ(find_intrusion(zone, course_of({-5, 21.9, 0}, 100)).entries, 0);
}

TEST(Goals, AFastTipDoesNotJumpOverAThinZone) {
  const auto scene = test::make_layered_scene();  // bursa from 22 to 24 mm
  const AvoidZone zone{
      "bursa", make_region_body(scene->joint(), region_named(scene->joint(), "bursa")), 0, true};
  EXPECT_EQ(find_intrusion(zone, course_of({1, 28}, 1)).entries, 1);
}

TEST(TipSight, SaysWhyATipIsNotSeen) {
  const auto scene = test::make_layered_scene();
  const TipSightFinder finder(Transducer{}, 40e-3, NeedleShape{});
  const auto look = [&](const Vec3& tip, const Vec3& axis, double lift = 0) {
    return finder.look(*scene, make_pose(Vec3(0, 0, -lift), Vec3::UnitZ(), Vec3::UnitX()),
                       make_pose(tip, axis, Vec3::UnitY()));
  };
  const Vec3 flat = Vec3(1, 0, 0.2).normalized();
  EXPECT_EQ(look(Vec3(0, 0, 20e-3), flat).loss, SightLoss::none);
  EXPECT_EQ(look(Vec3(0, 3e-3, 20e-3), flat).loss, SightLoss::off_plane);
  EXPECT_EQ(look(Vec3(25e-3, 0, 20e-3), flat).loss, SightLoss::off_sector);
  EXPECT_EQ(look(Vec3(0, 0, 35e-3), flat).loss, SightLoss::shadow);
  EXPECT_EQ(look(Vec3(0, 0, 20e-3), flat, 6e-3).loss, SightLoss::no_contact);
  EXPECT_EQ(look(Vec3(0, 0, 20e-3), Vec3::UnitZ()).loss, SightLoss::angle);
  EXPECT_NEAR(look(Vec3(0, -3e-3, 20e-3), flat).offset, -3e-3, 1e-12);
}

TEST(TipSight, GoesByTheNeedleOfTheLook) {
  const auto scene = test::make_layered_scene();
  const Pose X_JP = make_pose(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX());
  for (const double degrees : {5.0, 15.0, 30.0, 45.0, 60.0}) {
    const double angle = degrees * kDegree;
    const Pose X_JN =
        make_pose(Vec3(0, 0, 20e-3), Vec3(std::cos(angle), 0, std::sin(angle)), Vec3::UnitY());
    const auto contrast = [&](Look l) {
      return TipSightFinder(Transducer{}, 40e-3, NeedleShape{}, l)
          .look(*scene, X_JP, X_JN)
          .contrast_db;
    };
    EXPECT_NEAR(contrast(Look::clinical), 20 * std::log10(needle_on_screen({}, angle)) + 40, 1e-9);
    EXPECT_EQ(contrast(Look::compound), contrast(Look::clinical));
    // The measured peak is narrow and stands on a plateau.
    EXPECT_EQ(contrast(Look::clinical) > contrast(Look::raw), degrees > 50) << degrees;
  }
}

TEST(ForceLayers, TheSpeedOfATouchIsTheHandsThoughPosesComeMoreSlowlyThanTicks) {
  for (const int ticks_a_pose : {1, 10, 33}) {
    ForceLayers forces(4);
    for (int i = 0; i <= 990; ++i) {  // 10 mm/s, told every few ticks
      FeltTick tick;
      tick.time = 1e-3 * i;
      tick.region = 2;
      tick.tip = Vec3(0, 0, 0.01 * 1e-3 * (i / ticks_a_pose * ticks_a_pose));
      tick.on_bone = i >= 700;
      forces.add(tick);
    }
    ASSERT_EQ(forces.touches().size(), 1U);
    EXPECT_NEAR(forces.touches()[0].speed, 0.01, 1e-9) << ticks_a_pose;
  }
}

TEST(ForceLayers, SumsByLayerAndCountsTouches) {
  ForceLayers forces(4);
  FeltTick tick;
  const auto run = [&](double from, double to, RegionId region, double force, bool bone) {
    for (int i = 0; i < std::lround((to - from) * 1000); ++i) {
      tick.time = from + 1e-3 * i;
      tick.region = region;
      tick.tissue = force;
      tick.on_bone = bone;
      tick.hard = bone ? 3 : 0;
      forces.add(tick);
    }
  };
  run(0, 1, 2, 0.5, false);
  run(1, 2, 3, 1.5, true);
  ARTUS_RUNS_REALTIME(ForceLayers::add, forces.add(tick));
  run(2, 2.2, 3, 1, false);
  run(2.2, 2.4, 3, 1, true);
  run(2.4, 3, 3, 1, false);
  run(3, 3.2, 3, 1, true);
  EXPECT_EQ(forces.touch_count(), 2U);
  EXPECT_EQ(forces.touches()[0].peak, 3);
  EXPECT_NEAR(forces.layers()[2].impulse / forces.layers()[2].time, 0.5, 1e-9);
  EXPECT_EQ(forces.layers()[3].peak, 1.5);
}

}  // namespace
}  // namespace artus
