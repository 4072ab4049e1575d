// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/assumed_structures.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/import/nearest_bones.h"
#include "tests/anatomy/surfaces/surface_samples.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::HasSubstr;

constexpr double kMm = 1e-3;

ImportedStructure ball(const std::string& name, const std::string& tissue, double x,
                       double radius) {
  ImportedStructure s;
  s.name = s.source = name;
  s.tissue = tissue;
  s.mesh = make_sphere(Vec3(x, 0, 0), radius);
  return s;
}

/// Two bones 3 mm apart, a muscle on one of them and one that no bone holds.
ImportedJoint knee() {
  ImportedJoint joint;
  joint.name = "knee";
  joint.structures = {
      ball("rectus", "muscle", -24 * kMm, 8 * kMm), ball("vastus", "muscle", -50 * kMm, 8 * kMm),
      ball("tibia", "bone", 18 * kMm, 14 * kMm), ball("femur", "bone", -15 * kMm, 16 * kMm)};
  joint.body = make_sphere(Vec3::Zero(), 60 * kMm);
  joint.body_by = "a test";
  return joint;
}

class AssumedStructures : public test::TemporaryFolder {
 protected:
  /// What the joint file reads after `options` were followed.
  Result<JointFile> made(ImportedJoint joint, const ImportOptions& options) {
    ARTUS_TRY(add_assumed(joint, options));
    ARTUS_TRY(write_imported_joint(joint, folder_, true));
    assumed_ = joint.assumed;
    return read_joint(folder_);
  }
  static std::vector<std::string> names(const JointFile& file) {
    std::vector<std::string> all;
    for (const Structure& s : file.structures) all.push_back(s.name);
    return all;
  }
  std::vector<std::string> assumed_;
};

TEST_F(AssumedStructures, CartilageAndRecessStandBehindTheBonesAndAreTold) {
  ImportOptions options;
  options.assume = {"cartilage", "recess"};
  const auto file = made(knee(), options);
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_THAT(names(*file),
              testing::ElementsAre("skin", "rectus", "vastus", "tibia", "femur", "joint_recess",
                                   "tibia_cartilage", "femur_cartilage"));
  EXPECT_EQ(file->structures[5].tissue, "synovial_fluid");  // which takes liquid as a joint does
  const auto& recess = std::get<GapConstruct>(file->structures[5].shape);
  EXPECT_THAT(recess.roof, testing::ElementsAre("tibia"));
  EXPECT_THAT(recess.floor, testing::ElementsAre("femur"));
  const auto& cap = std::get<CapConstruct>(file->structures[6].shape);
  EXPECT_EQ(cap.on, "tibia");
  EXPECT_THAT(cap.near, testing::ElementsAre("femur"));
  EXPECT_THAT(assumed_, testing::Contains(HasSubstr("cartilage of 1.5 mm on 'femur'")));
  EXPECT_THAT(assumed_, testing::Contains(HasSubstr("recess of 1 mm")));
}

TEST_F(AssumedStructures, SegmentedCartilageIsKeptAndIsAWallOfTheRecess) {
  ImportedJoint joint = knee();
  joint.structures.insert(joint.structures.begin(), ball("pad", "cartilage", 5 * kMm, 1.2 * kMm));
  ImportOptions options;
  options.assume = {"cartilage", "recess"};
  const auto file = made(joint, options);
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_THAT(names(*file), testing::Not(testing::Contains("tibia_cartilage")));
  const auto at = std::find_if(file->structures.begin(), file->structures.end(),
                               [](const Structure& s) { return s.name == "joint_recess"; });
  ASSERT_NE(at, file->structures.end());
  EXPECT_THAT(std::get<GapConstruct>(at->shape).roof, testing::ElementsAre("tibia", "pad"));
}

TEST_F(AssumedStructures, ATendonIsTheEndOfAMuscleThatABoneHolds) {
  ImportOptions options;
  options.assume = {"tendons"};
  const auto file = made(knee(), options);
  ASSERT_TRUE(file) << file.error().to_string();
  const auto& end = std::get<EndConstruct>(file->structures.back().shape);
  EXPECT_EQ(file->structures.back().name, "rectus_tendon");
  EXPECT_EQ(end.of, "rectus");
  EXPECT_EQ(end.toward, "femur");
  EXPECT_THAT(names(*file), testing::Not(testing::Contains("vastus_tendon")));
}

TEST_F(AssumedStructures, ABursaStandsBeforeItsSoftWallsAndIsTwiceAsThickAtAHardOne) {
  ImportOptions options;
  options.bursa = {"rectus", "femur"};
  const auto file = made(knee(), options);
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_THAT(names(*file), testing::ElementsAre("skin", "vastus", "tibia", "femur",
                                                 "rectus_femur_bursa", "rectus"));
  EXPECT_NEAR(std::get<GapConstruct>(file->structures[4].shape).thickness, 3 * kMm, 1e-12);
}

TEST_F(AssumedStructures, WhatCannotBeMadeIsSaid) {
  ImportOptions options;
  options.assume = {"cartilge"};
  EXPECT_THAT(made(knee(), options).error().to_string(), HasSubstr("cartilage"));
  ImportedJoint alone = knee();
  alone.structures.resize(2);
  for (const char* what : {"cartilage", "recess", "tendons"}) {
    options.assume = {what};
    EXPECT_FALSE(made(alone, options)) << what;
  }
  options.assume = {};
  options.bursa = {"rectus", "femurr"};
  EXPECT_THAT(made(knee(), options).error().to_string(), HasSubstr("femur"));
}

TEST(NearestBones, OfNearBonesThoseWhoseSmallerIsLargest) {
  ImportedJoint joint = knee();
  joint.structures.push_back(ball("fabella", "bone", 36 * kMm, 3 * kMm));
  const auto samples = sample_structures(joint);
  const auto pair = find_joint_bones(joint, {}, samples);
  ASSERT_TRUE(pair && *pair);
  EXPECT_EQ((*pair)->first, 2U);
  EXPECT_EQ((*pair)->second, 3U);
  EXPECT_NEAR(nearest_of(samples[2], samples[3]).distance, 3 * kMm, 2 * kMm);
  EXPECT_TRUE(are_apart(samples[1], samples[2], 15 * kMm));
  EXPECT_FALSE(find_joint_bones(joint, {"femur", "fibula"}, samples));
}

}  // namespace
}  // namespace artus
