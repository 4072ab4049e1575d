// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/needle_drag.h"

#include <gtest/gtest.h>

#include "tests/apps/run_tool.h"

namespace artus {
namespace {

/// The place of a tip decides how a length is rounded, never whether the tip pushes.
TEST(NeedleDrag, ATipThatGoesInPushesWhateverSoftLayerItIsIn) {
  auto loaded = read_compiled_joint(test::kSimple);
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  const auto joint = std::make_shared<const CompiledJoint>(std::move(*loaded));
  const Scene scene(joint);
  const Pose& X_JP = joint->X_JP_default;
  int n = 0;
  for (const double tilt : {-0.7, -0.3, 0.01, 0.4, 0.9}) {
    NeedleView needle;
    needle.X_JN = X_JP * Eigen::AngleAxisd(tilt, Vec3::UnitY());
    const Vec3 skin = needle.X_JN.translation();
    for (double depth = 0.3e-3; depth < 20e-3; depth += 0.07e-3) {
      needle.X_JN.translation() = skin + depth * needle.X_JN.linear().col(2);
      const RegionId region = scene.region_at(needle.X_JN.translation());
      if (region < kFirstRegion || joint->tissue_of(region).haptic.hard) continue;
      const NeedleDrag drag = find_drag(scene, needle, NeedleDirection::in, 1e-3);
      EXPECT_GT(drag.tip_force, 0) << tilt << ", " << depth;
      EXPECT_GT(drag.push, 0) << tilt << ", " << depth;
      EXPECT_EQ(find_drag(scene, needle, NeedleDirection::out, 1e-3).tip_force, 0);
      ++n;
    }
  }
  EXPECT_GT(n, 700);
}

}  // namespace
}  // namespace artus
