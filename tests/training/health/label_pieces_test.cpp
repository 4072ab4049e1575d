// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/label_pieces.h"

#include <string>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr RegionId kFat = 2;
constexpr RegionId kMuscle = 3;
constexpr RegionId kBursa = 4;
constexpr RegionId kBone = 5;
constexpr int kWide = 100;  // pixels of 0.2 mm
constexpr int kHigh = 60;

/// Fat, muscle, bursa and bone as layers.
LabelImage flat_labels() {
  LabelImage labels;
  labels.width = kWide;
  labels.height = kHigh;
  labels.pixel = 0.2e-3;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x)
      labels.regions.push_back(y < 15 ? kFat : y < 40 ? kMuscle : y < 45 ? kBursa : kBone);
  return labels;
}

void fill(LabelImage& labels, const LabelWindow& box, RegionId region) {
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x)
      labels.regions[static_cast<std::size_t>(y * kWide + x)] = region;
}

CompiledJoint names() {
  CompiledJoint joint;
  joint.tissues.resize(2);
  joint.tissues[1].haptic.hard = true;
  for (const char* name : {"outside", "beyond", "fat", "muscle", "bursa", "bone", "injected"})
    joint.regions.push_back(
        {name, static_cast<TissueId>(name == std::string("bone") ? 1 : 0), Vec3::Zero(), {}});
  return joint;
}

const std::vector<bool> kLiquid{false, false, false, false, true, false, true};
const std::vector<bool> kInjected{false, false, false, false, false, false, true};

LayoutChange change_to(LabelImage after, const std::vector<bool>& parted = {}) {
  LabelImage before = flat_labels();
  join_liquid(before, kLiquid, kInjected);
  join_liquid(after, kLiquid, kInjected);
  const LabelWindow window{0, kWide, 0, kHigh};
  return compare_layouts(find_layout(before, window, 1e-6), find_layout(after, window, 1e-6),
                         names(), parted);
}

TEST(LabelPieces, AWiderBursaIsNoChange) {
  LabelImage wider = flat_labels();
  fill(wider, {30, 70, 30, 45}, kBursa);
  const LayoutChange change = change_to(wider);
  EXPECT_EQ(change.fragments, 0);
  EXPECT_EQ(change.neighbours, 0);
}

TEST(LabelPieces, AMuscleCutInTwoIsAFragmentAndItsLiquidANewNeighbour) {
  LabelImage cut = flat_labels();
  fill(cut, {40, 60, 15, 45}, kBursa);  // a column up to the fat
  const LayoutChange change = change_to(cut);
  EXPECT_EQ(change.fragments, 1);
  EXPECT_EQ(change.which_fragments, "muscle 1 -> 2");
  EXPECT_EQ(change.neighbours, 1);
  EXPECT_EQ(change.which_neighbours, "fat at liquid");
}

TEST(LabelPieces, CrumbsAndShortContactsDoNotCount) {
  LabelImage crumbs = flat_labels();
  fill(crumbs, {20, 23, 5, 8}, kMuscle);
  const LayoutChange change = change_to(crumbs);
  EXPECT_EQ(change.fragments, 0);
  EXPECT_EQ(change.neighbours, 0);
}

TEST(LabelPieces, ASlabOfMuscleInFatAndBoneInMuscleAreWhereTheyWereNot) {
  LabelImage slabs = flat_labels();
  fill(slabs, {20, 40, 4, 10}, kMuscle);
  fill(slabs, {60, 90, 20, 30}, kBone);
  const LayoutChange change = change_to(slabs);
  EXPECT_EQ(change.fragments, 2);
  EXPECT_EQ(change.which_neighbours, "muscle at bone");
}

TEST(LabelPieces, LiquidThatPartsTissueMayTouchItAndWhatIsBesideItButNotBone) {
  const std::vector<bool> muscle{false, false, false, true};
  LabelImage parted = flat_labels();
  fill(parted, {30, 60, 10, 30}, 6);
  EXPECT_EQ(change_to(parted, muscle).neighbours, 0);
  LabelImage through = parted;
  fill(through, {30, 60, 30, 50}, 6);
  const LayoutChange change = change_to(through, muscle);
  EXPECT_EQ(change.neighbours, 1);
  EXPECT_EQ(change.which_neighbours, "bone at liquid");
}

TEST(LabelPieces, WhatLiquidPartsIsOneStructureStillWhatASpaceCutsIsNot) {
  LabelImage parted = flat_labels();
  fill(parted, {40, 60, 15, 40}, 6);
  EXPECT_EQ(change_to(parted, {false, false, false, true}).fragments, 0);
  LabelImage astray = parted;
  fill(astray, {5, 20, 2, 10}, kMuscle);  // a piece in the fat that no liquid joins to the rest
  EXPECT_EQ(change_to(astray, {false, false, false, true}).which_fragments, "muscle 1 -> 2");
}

TEST(LabelPieces, WhatHangsTogetherBesideTheWindowIsOnePiece) {
  LabelImage cut = flat_labels();
  fill(cut, {10, 60, 15, 45}, kBursa);
  LabelImage joined = cut;
  fill(joined, {10, 60, 15, 17}, kMuscle);  // a bridge in the margin above the window
  const LabelWindow below{0, kWide, 20, kHigh};
  EXPECT_EQ(find_layout(cut, below, 1e-6).pieces.at(kMuscle), 2);
  EXPECT_EQ(find_layout(joined, below, 1e-6).pieces.at(kMuscle), 1);
}

TEST(LabelPieces, WhatAPicturesNeighbourHasMayComeIntoIt) {
  RegionLayout here;
  here.pieces = {{4, 1}, {5, 2}};
  here.contacts = {{{4, 5}, 1e-3}};
  RegionLayout beside;
  beside.pieces = {{5, 1}, {6, 1}};
  beside.contacts = {{{4, 5}, 3e-3}, {{5, 6}, 2e-3}};
  here.add(beside);
  EXPECT_EQ(here.pieces, (std::map<RegionId, int>{{4, 1}, {5, 2}, {6, 1}}));
  EXPECT_EQ(here.contacts.at({4, 5}), 3e-3);
  EXPECT_EQ(here.contacts.at({5, 6}), 2e-3);
}

}  // namespace
}  // namespace artus
