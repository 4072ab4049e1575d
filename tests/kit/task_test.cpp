// SPDX-License-Identifier: AGPL-3.0-or-later
// A whole gel task by rendered hands: pictures, poses, messages as a session takes them, marks. One
// hand passes, another stops short of the target and fails. ARTUS_KIT_PICTURES keeps the pictures
// of the first, for scripts/check-hands.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>

#include "artus/detail/core/printed.h"
#include "artus/detail/devices/kit/kit_file.h"
#include "artus/detail/devices/kit/pose_sender.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/tracker_device.h"
#include "artus/detail/training/assessment.h"
#include "artus/detail/training/judgement.h"
#include "artus/detail/training/player.h"
#include "artus/detail/training/scenario.h"
#include "tests/kit/scenes.h"

namespace artus::kit {
namespace {

constexpr double kBlock = 50e-3;  // m

/// The sheet's frame in the joint, for a task whose probe stands on the middle of the block.
Pose sheet_in_joint(const Scenario& scenario) {
  Pose X_RS = Pose::Identity();
  X_RS.translation().z() = -kBlock;
  return block_in_joint(scenario.X_JP) * X_RS;
}

/// How far the needle has gone at a time, m: in from 18 mm before the skin, rest, out again.
double way_at(double time, double length) {
  constexpr double kBefore = 18e-3;
  constexpr double kIn = 2.0;    // s
  constexpr double kRest = 1.2;  // s
  const double whole = kBefore + length;
  if (time < 0.4) return 0;
  if (time < 0.4 + kIn) return whole * (time - 0.4) / kIn;
  if (time < 0.4 + kIn + kRest) return whole;
  return std::max(0.0, whole * (1 - (time - 0.4 - kIn - kRest) / 1.2));
}

/// Tracked poses in the joint, over the messages that a session takes.
TrackedList follow(const Scenario& scenario, double length, const std::string& folder) {
  const double lasts = folder.empty() ? 5.2 : 6;   // s; the kept ones are shown again and again
  const double rate = folder.empty() ? 12.0 : 30;  // pictures a second
  Kit kit;
  kit.block_height = kBlock;
  const test::ViewRenderer renderer(kit.lens);
  test::ViewFlaws flaws;
  flaws.hidden = 0;
  Tracker tracker(kit);
  TrackerInbox inbox({}, {});
  inbox.register_at(block_in_joint(scenario.X_JP));
  test::KitScene scene;
  scene.X_SC = test::camera_at(0.5, 0.6, 0.1);
  const Pose X_SJ = sheet_in_joint(scenario).inverse();
  scene.X_SP = X_SJ * scenario.X_JP;
  const Vec3 direction = (scenario.target.point - scenario.entry.centre).normalized();
  TrackedList list;
  std::int64_t number = 0;
  for (double time = 0; time < lasts; time += 1 / rate, ++number) {
    const Vec3 tip = scenario.entry.centre + (way_at(time, length) - 18e-3) * direction;
    const double steep = std::asin(direction.z());
    scene.X_SN = test::needle_towards(scenario.X_JP.inverse() * tip, steep, 0, scene.X_SP);
    const cv::Mat view =
        renderer.render(test::bodies_of(scene, kit), flaws, static_cast<std::uint64_t>(number + 1));
    if (!folder.empty())
      cv::imwrite(folder + printed("/hand_%05dms.jpg", static_cast<int>(1e3 * time)), view);
    const HandsFrame frame = tracker.take(view, time);
    for (const igtl::Message& message : messages_of(frame, kBlock))
      EXPECT_TRUE(inbox.take(message, number + 1));
    TrackedPoses poses;
    if (!inbox.load(poses) || poses.needle_ns != number + 1 || poses.probe_ns != number + 1)
      continue;
    list.poses.push_back({time, to_pose(poses.X_WN), to_pose(poses.X_WP)});
  }
  return list;
}

Judgement judge_hand(const Scenario& scenario, double length, const std::string& folder = "") {
  const auto scene = make_gel_scene(*scenario.gel);
  const auto params = make_session_params(scenario);
  auto options = make_meter_options(scenario, (*scene)->joint(), *params);
  const TrackedList list = follow(scenario, length, folder);
  EXPECT_GT(list.poses.size(), 40U);
  const Assessment assessed = assess_list(list, *scene, std::move(*options));
  return judge(assessed.metrics, scenario.pass, scenario.score, false, false);
}

TEST(KitTask, AGelTaskIsPassedAndFailedByRenderedHands) {
  cv::setNumThreads(1);
  const auto scenario = find_scenario("gel-find");
  ASSERT_TRUE(scenario);
  const double whole = (scenario->target.point - scenario->entry.centre).norm();
  const char* kept = std::getenv("ARTUS_KIT_PICTURES");  // NOLINT(concurrency-mt-unsafe)
  if (kept != nullptr) {
    MeasuredKit measured = make_kit(Hand::right, 1, kBlock);
    measured.has_camera = measured.has_tip = measured.has_face = true;
    std::ofstream(std::string(kept) + "/hands.toml") << to_toml(measured);
  }
  const Judgement good = judge_hand(*scenario, whole, kept == nullptr ? "" : kept);
  for (const JudgedMark& mark : good.marks)
    EXPECT_TRUE(mark.held) << mark.mark.metric << " " << mark.value.value_or(-1);
  EXPECT_TRUE(good.passed);
  const Judgement stopped = judge_hand(*scenario, whole - 10e-3);
  EXPECT_FALSE(stopped.passed);
  ASSERT_TRUE(stopped.marks[0].value);
  EXPECT_NEAR(*stopped.marks[0].value, 10, 1.7) << stopped.marks[0].mark.metric;
}

}  // namespace
}  // namespace artus::kit
