// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/seen_structures.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr RegionId kFat = kFirstRegion;
constexpr RegionId kTendon = kFirstRegion + 1;
constexpr RegionId kVein = kFirstRegion + 2;

CompiledJoint joint_of_three() {
  CompiledJoint joint;
  joint.regions.resize(kFirstRegion + 3);
  joint.regions[kFat].name = "fat";
  joint.regions[kTendon].name = "tendon";
  joint.regions[kVein].name = "vein";
  return joint;
}

/// 20 columns of 20 pixels of a millimetre: two of gel, fat, tendon from 8 mm below the skin on;
/// in the right half a vein at 3 mm.
LabelImage picture_of_three() {
  LabelImage labels;
  labels.width = 20;
  labels.height = 20;
  labels.pixel = 1e-3;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      RegionId region = y < 2 ? RegionId{kOutside} : kFat;
      if (y >= 10) region = kTendon;
      if (x >= 14 && y >= 5 && y < 7) region = kVein;
      labels.regions.push_back(region);
    }
  return labels;
}

std::vector<SightFault> faults_of(const std::vector<ViewSight>& sights) {
  StandardView view;
  view.sights = sights;
  std::vector<SightFault> faults;
  for (const SeenStructure& seen : find_seen(picture_of_three(), joint_of_three(), view))
    faults.push_back(seen.fault);
  return faults;
}

TEST(SeenStructures, AreMeasuredBelowTheSkinNotBelowTheFace) {
  StandardView view;
  view.sights = {{"tendon", 7e-3, 9e-3, {}}, {"vein", 2e-3, 4e-3, ViewSide::right}};
  const auto seen = find_seen(picture_of_three(), joint_of_three(), view);
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_DOUBLE_EQ(seen[0].depth, 8e-3);
  EXPECT_DOUBLE_EQ(seen[0].share, 1);
  EXPECT_DOUBLE_EQ(seen[1].depth, 3e-3);
  EXPECT_DOUBLE_EQ(seen[1].share, 0.3);
  EXPECT_GT(seen[1].side, 0.5);
  for (const SeenStructure& s : seen) EXPECT_EQ(s.fault, SightFault::none) << s.structure;
}

TEST(SeenStructures, TellWhatIsNotAsTheViewSays) {
  using enum SightFault;
  EXPECT_EQ(faults_of({{"bone", 0, 1, {}}}), std::vector{not_seen});
  EXPECT_EQ(faults_of({{"tendon", 1e-3, 5e-3, {}}}), std::vector{depth});
  EXPECT_EQ(faults_of({{"vein", 0, 9e-3, ViewSide::left}}), std::vector{side});
  EXPECT_EQ(faults_of({{"tendon", 0, 9e-3, {}}, {"vein", 0, 9e-3, {}}}),
            (std::vector{none, order}));
  EXPECT_EQ(faults_of({{"tendon", 0, 9e-3, {}}, {"vein", 0, 9e-3, ViewSide::right}}),
            (std::vector{none, none}))
      << "what has a side stands beside";
}

}  // namespace
}  // namespace artus
