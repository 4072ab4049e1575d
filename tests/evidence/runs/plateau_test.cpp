// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/plateau.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace artus {
namespace {

// Bone of 4 N and 4000 N/m: the force is there when the tip is pressed in by 1 mm.
PlateauFinder bone_finder() {
  Haptic haptic;
  haptic.cutting_force = 4;
  haptic.wall_stiffness = 4000;
  return PlateauFinder({{"bone", haptic}});
}

/// A row on bone, pressed in by `in_bone` and still going deeper, or held.
NeedleRow pressed(double time, double in_bone, bool held = false) {
  NeedleRow row;
  row.time = time;
  row.region = 0;
  row.state = ContactState::bone;
  row.depth = 0.02 + in_bone;
  row.in_bone = in_bone;
  row.velocity = held ? 0 : 0.01;
  row.forces.cutting = -std::min(4.0, 4000 * in_bone);
  return row;
}

TEST(Plateau, OnBoneBeginsWhenTheTipIsPressedInFarEnoughAlsoAfterAPause) {
  PlateauFinder finder = bone_finder();
  double time = 0;
  for (double in_bone = 0; in_bone < 2e-3; in_bone += 0.05e-3) {
    const bool pauses = in_bone > 0.5e-3 && in_bone < 0.6e-3;
    finder.add(pressed(time += 0.03, in_bone, pauses));
  }
  const auto plateaus = finder.plateaus();
  ASSERT_EQ(plateaus.size(), 1U);
  EXPECT_GT(plateaus[0].rows, 10U);
  EXPECT_DOUBLE_EQ(plateaus[0].least, 4);
  EXPECT_NEAR(plateaus[0].rise, 1e-3, 1e-6);
}

}  // namespace
}  // namespace artus
