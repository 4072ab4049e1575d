// SPDX-License-Identifier: AGPL-3.0-or-later
// Where an attempt begins: the needle in the air over its entry, whatever the task and its level.
#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/units.h"
#include "artus/detail/trainer/lesson.h"
#include "artus/detail/training/metrics/closed_body.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

constexpr double kReach = 0.1;  // m in which skin is looked for

/// The skin of a scenario's joint, whole: also where nothing is meshed. The face of a block of gel
/// is the plane z = 0.
class Skins {
 public:
  double distance(const Scenario& scenario, const Vec3& p_J) {
    if (scenario.gel) return -p_J.z();
    std::shared_ptr<const Scene>& skin = skins_[scenario.joint];
    if (!skin) {
      const auto file = test::source_dir() / "meshes" / scenario.joint / "surfaces" / "body.ply";
      const auto surface = read_surface(file, kMillimetre);
      EXPECT_TRUE(surface) << file;
      skin = make_closed_body(surface->vertices, surface->triangles, "body");
    }
    return skin->signed_distance_to_skin(p_J, kReach);
  }

 private:
  std::map<std::string, std::shared_ptr<const Scene>> skins_;
};

TEST(FirstHands, TheWholeNeedleIsInTheAirNearItsEntryInEveryTaskAtEveryLevel) {
  constexpr double kClear = 1e-3;  // m between skin and any point of the needle
  constexpr double kFar = 40e-3;   // m of the tip from its entry
  constexpr int kHighest = 8;
  Skins skins;
  int tasks = 0;
  for (const std::string_view text : bundled_scenario_texts()) {
    auto scenario = parse_scenario(text, "bundled");
    ASSERT_TRUE(scenario);
    ++tasks;
    if (!scenario->find.empty()) continue;
    for (scenario->level = 0; scenario->level <= kHighest; ++scenario->level) {
      const Pose X_JN = to_pose(first_hands(*scenario).X_WN);
      const Vec3 tip = X_JN.translation();
      EXPECT_LE((tip - scenario->entry.centre).norm(), kFar) << scenario->name;
      for (double back = 0; back <= scenario->needle_length; back += 2e-3)
        EXPECT_GE(skins.distance(*scenario, tip - back * X_JN.linear().col(2)), kClear)
            << scenario->name << ", level " << scenario->level << ", " << back / kMillimetre
            << " mm behind the tip";
    }
  }
  EXPECT_EQ(tasks, 36);
}

}  // namespace
}  // namespace artus
