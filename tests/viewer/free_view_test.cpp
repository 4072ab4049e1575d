// SPDX-License-Identifier: AGPL-3.0-or-later
// From where a joint is seen at first, with the person around it.
#include "artus/detail/viewer/joint3d/free_view.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "artus/anatomy/joint_file.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

class FreeView : public testing::TestWithParam<const char*> {};

TEST_P(FreeView, NothingOfThePersonStandsBeforeTheJoint) {
  const auto joint = read_joint(test::source_dir() / "meshes" / GetParam());
  ASSERT_TRUE(joint) << joint.error().to_string();
  const auto body = read_outside(*joint);
  ASSERT_TRUE(body && *body);
  ASSERT_TRUE(joint->X_JP_default);
  const Pose& X_JP = *joint->X_JP_default;
  for (const double lateral : {1.0, -1.0}) {  // whichever way round the probe is held
    OrbitCamera camera;
    camera.centre = X_JP * Vec3(0, 0, 15e-3);
    camera.up = -X_JP.linear().col(2);
    camera.side = lateral * X_JP.linear().col(0);
    camera.yaw = -1.15;
    camera.pitch = 0.5;
    camera.distance = 0.36;
    const double asked = covered_share(**body, camera);
    camera = find_free_view(**body, camera);
    const double now = covered_share(**body, camera);
    EXPECT_LE(now, asked);
    EXPECT_LT(now, std::max(0.1, 0.7 * asked))
        << "a person who lies has the hip between belly and hand";
    if (asked <= 0.05) {
      EXPECT_EQ(camera.yaw, -1.15) << "a free view stays as it is";
      EXPECT_EQ(camera.pitch, 0.5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bundled, FreeView,
                         testing::Values("shoulder", "hip", "knee", "elbow", "wrist", "ankle"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace artus
