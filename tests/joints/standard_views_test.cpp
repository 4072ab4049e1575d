// SPDX-License-Identifier: AGPL-3.0-or-later
// Every view of the bundled joints shows what its protocol names: there, at its depth, in order and
// on its side, by the truth of the picture.
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/echo/display/seen_structures.h"
#include "artus/echo/labels.h"
#include "artus/raycast/scene.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

class StandardViews : public testing::TestWithParam<std::string> {};

TEST_P(StandardViews, ShowWhatTheirProtocolsName) {
  const auto file = test::test_joints() / (GetParam() + ".artus");
  // Its surfaces are others'; who has them compiles it there (meshes/real-shoulder/README.md).
  if (GetParam() == "real-shoulder" && !std::filesystem::exists(file))
    GTEST_SKIP() << file << " is not there";
  auto read = read_compiled_joint(file);
  ASSERT_TRUE(read) << read.error().to_string();
  const auto joint = std::make_shared<const CompiledJoint>(std::move(*read));
  const Scene scene(joint);
  EXPECT_GE(joint->views.size(), 6U);
  for (const StandardView& view : joint->views) {
    if (!view.pose.empty()) continue;  // another body
    ImageSettings settings;
    if (view.depth > 0) settings.depth = view.depth;
    settings.pixel = 0.2e-3;
    const LabelImage labels = render_labels(scene, view.X_JP, Transducer{}, settings);
    EXPECT_GE(view.sights.size(), 2U) << view.name;
    for (const SeenStructure& seen : find_seen(labels, *joint, view))
      EXPECT_EQ(seen.fault, SightFault::none)
          << view.name << ": " << seen.structure << " in " << 100 * seen.share << " % at "
          << 1e3 * seen.depth << " mm, side " << seen.side;
  }
}

INSTANTIATE_TEST_SUITE_P(Joints, StandardViews,
                         testing::Values("shoulder", "knee", "hip", "elbow", "wrist", "ankle",
                                         "real-shoulder"));

}  // namespace
}  // namespace artus
