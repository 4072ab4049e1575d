// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/structure_names.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

namespace artus {
namespace {

std::string tissue_of(const std::string& name, const std::string& code = {},
                      const StructureNames& user = {}) {
  const auto bundled = read_bundled_structure_names();
  if (!bundled) return bundled.error().to_string();
  const auto known = find_tissue(user, *bundled, name, code);
  return known ? known->tissue : "unknown";
}

TEST(StructureNames, NamesLoseCaseSideAndEnding) {
  EXPECT_EQ(plain_structure_name("Deltoid muscle.l"), "deltoid_muscle");
  EXPECT_EQ(plain_structure_name("humerus_left"), "humerus");
  EXPECT_EQ(plain_structure_name("Right Femur"), "femur");
  EXPECT_EQ(side_of_name("Deltoid muscle.r"), "right");
  EXPECT_EQ(side_of_name("humerus_left"), "left");
  EXPECT_EQ(side_of_name("patella"), "none");
  EXPECT_EQ(side_of_name("l"), "none");  // a name, not a side
}

TEST(StructureNames, WordsAreWholeAndTogether) {
  EXPECT_TRUE(fits("femur", "femur"));
  EXPECT_TRUE(fits("femur", "head_of_femur"));
  EXPECT_FALSE(fits("rib", "tribe"));
  EXPECT_TRUE(fits("gluteus*", "gluteus_maximus"));
  EXPECT_FALSE(fits("hip_bone", "bone_of_hip"));
  EXPECT_TRUE(fits("*_fat", "subcutaneous_fat"));
}

TEST(StructureNames, TablesKnowTheirSources) {
  EXPECT_EQ(tissue_of("humerus_left"), "bone");
  EXPECT_EQ(tissue_of("vertebrae_L5"), "bone");
  EXPECT_EQ(tissue_of("gluteus_maximus_right"), "muscle");
  EXPECT_EQ(tissue_of("iliac_artery_left"), "artery");
  EXPECT_EQ(tissue_of("inferior_vena_cava"), "vein");
  EXPECT_EQ(tissue_of("costal_cartilages"), "cartilage");
  EXPECT_EQ(tissue_of("subcutaneous_fat"), "fat");
  EXPECT_EQ(tissue_of("body_trunc"), "body");
  EXPECT_EQ(tissue_of("Femoral Cartilage"), "cartilage");  // not the bone in its name
  EXPECT_EQ(tissue_of("Tendon of long head of biceps brachii.r"), "tendon");
  EXPECT_EQ(tissue_of("Femoral nerve.l"), "nerve");
  EXPECT_EQ(tissue_of("Medial meniscus"), "labrum");
  EXPECT_EQ(tissue_of("Segment_1"), "unknown");
  EXPECT_EQ(tissue_of("Segment_1", "SCT 272673000"), "bone");
  EXPECT_EQ(tissue_of("spleen"), "unknown");
}

TEST(StructureNames, TheUsersFileIsAskedFirst) {
  const auto user = parse_structure_names(
      "[[label]]\nvalue = 3\nname = \"thing\"\ntissue = \"tendon\"\n"
      "[[map]]\nmatch = \"femur\"\ntissue = \"muscle\"\n",
      "names.toml");
  ASSERT_TRUE(user) << user.error().to_string();
  EXPECT_EQ(tissue_of("femur", "SCT 272673000", *user), "muscle");
  EXPECT_EQ(tissue_of("thing", {}, *user), "tendon");
}

TEST(StructureNames, AWrongFileIsToldAllAtOnce) {
  const auto user = parse_structure_names(
      "[[label]]\nvalue = 0\nname = \"thing\"\n[[map]]\nmatch = \"x\"\ntissue = \"bones\"\n",
      "names.toml");
  ASSERT_FALSE(user);
  EXPECT_THAT(user.error().message, testing::HasSubstr("did you mean 'bone'"));
  EXPECT_THAT(user.error().message, testing::HasSubstr("value"));
}

}  // namespace
}  // namespace artus
