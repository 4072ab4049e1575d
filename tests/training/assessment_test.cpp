// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/assessment.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/session/session_support.h"

namespace artus {
namespace {

TEST(Assessment, ANameThatIsNotThereIsRefusedWithTheNearest) {
  const auto scene = test::make_layered_scene();
  GoalNames names;
  names.structure = "brsa";
  const auto goals = make_goals(scene->joint(), names);
  ASSERT_FALSE(goals);
  EXPECT_EQ(goals.error().code, ErrorCode::not_found);
  EXPECT_NE(goals.error().message.find("did you mean 'bursa'"), std::string::npos);
  names.structure = "bursa";
  names.avoid.emplace_back("nerve of nowhere", 1e-3);
  EXPECT_FALSE(make_goals(scene->joint(), names));
}

TEST(Assessment, AStraightWayIsAsLongAsItIs) {
  const auto scene = test::make_layered_scene();
  TrackedList list;
  const double speed = 10e-3;  // m/s
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.01 * i;
    list.poses.push_back({t, make_pose({0, 0, speed * t}, Vec3::UnitZ(), Vec3::UnitX()), {}});
  }
  list.notices.emplace_back("told");
  MeterOptions options;
  GoalNames names;
  names.point = Vec3(3e-3, 0, 20e-3);
  options.goals = *make_goals(scene->joint(), names);
  const Assessment done = assess_list(list, scene, options);
  const Metric* path = find_metric(done.metrics, "path_length_mm", "needle");
  ASSERT_TRUE(path != nullptr && path->value);
  EXPECT_NEAR(*path->value, 20, 0.2);
  const Metric* distance = find_metric(done.metrics, "distance_mm");
  ASSERT_TRUE(distance != nullptr && distance->value);
  EXPECT_NEAR(*distance->value, 3, 0.05);
  EXPECT_NE(distance->definition.find("the point"), std::string::npos);
  const auto json = to_json(done);
  EXPECT_EQ(json.at("notices").at(0), "told");
  EXPECT_EQ(json.at("metrics").size(), done.metrics.size());
}

TEST(Assessment, ANeedleThatIsInsideAtTheStartDidNotGoThroughTheSkin) {
  const auto scene = test::make_layered_scene();
  const auto contact_from = [&](double depth) {
    TrackedList list;
    for (int i = 0; i <= 200; ++i) {
      const Vec3 tip(0, 0, depth + 10e-3 * 0.01 * i);
      list.poses.push_back({0.01 * i, make_pose(tip, Vec3::UnitZ(), Vec3::UnitX()), {}});
    }
    const Assessment done = assess_list(list, scene, {});
    const auto contact = std::find_if(done.events.begin(), done.events.end(),
                                      [](const AttemptEvent& e) { return e.kind == "contact"; });
    return contact == done.events.end() ? std::string() : contact->text;
  };
  EXPECT_EQ(contact_from(-5e-3), "the needle went through the skin");
  EXPECT_EQ(contact_from(5e-3), "the needle was inside from the start");
}

}  // namespace
}  // namespace artus
