// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/joint_path.h"

#include <gmock/gmock.h>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::ElementsAre;

TEST(JointPath, APathNamesFolderAndVariants) {
  const JointChoice plain = split_variants("meshes/shoulder");
  EXPECT_EQ(plain.folder, "meshes/shoulder");
  EXPECT_TRUE(plain.variants.empty());
  const JointChoice two = split_variants("meshes/shoulder+tear+effusion+tear");
  EXPECT_EQ(two.folder, "meshes/shoulder");
  EXPECT_THAT(two.variants, ElementsAre("effusion", "tear"));
  EXPECT_EQ(with_variant("meshes/shoulder", "tear"), "meshes/shoulder+tear");
  EXPECT_EQ(with_variant("meshes/shoulder/", "tear"), "meshes/shoulder+tear");
}

class JointPathFolder : public test::TemporaryFolder {};

TEST_F(JointPathFolder, AFolderWhoseNameHasAPlusIsThatFolder) {
  std::filesystem::create_directory(in("knee+old"));
  EXPECT_TRUE(split_variants(in("knee+old")).variants.empty());
  EXPECT_TRUE(is_joint_folder(in("knee+old")));
  EXPECT_TRUE(is_joint_folder(in("knee+old+effusion")));
  EXPECT_FALSE(is_joint_folder(in("hip+effusion")));
}

TEST_F(JointPathFolder, ABundledJointIsFoundByItsNameWhereThereIsNoneOfOnesOwn) {
  const std::filesystem::path meshes = test::source_dir() / "meshes";
  for (const char* name :
       {"shoulder", "shoulder/", "meshes/shoulder", "shoulder+effusion@fat=12"}) {
    const JointChoice choice = split_variants(find_joint(name));
    EXPECT_TRUE(std::filesystem::equivalent(choice.folder, meshes / "shoulder")) << name;
    EXPECT_TRUE(is_joint_folder(name)) << name;
  }
  const JointChoice wet = split_variants(find_joint("shoulder+effusion@fat=12"));
  EXPECT_THAT(wet.variants, ElementsAre("effusion"));
  EXPECT_EQ(wet.patient, "fat=12");
  EXPECT_EQ(find_joint("jaw"), "jaw");
  EXPECT_EQ(find_joint("mine/shoulder"), "mine/shoulder") << "a path is no name";
  std::filesystem::create_directory(in("shoulder"));
  EXPECT_EQ(find_joint(in("shoulder")), in("shoulder"));
}

TEST(JointPath, VariantsAndPatientsAreTakenFromThePath) {
  const JointChoice choice = split_variants("meshes/arm+tear+pus@old_f_tear,fat=3.5");
  EXPECT_EQ(choice.folder, "meshes/arm");
  EXPECT_EQ(choice.variants, (std::vector<std::string>{"pus", "tear"}));
  EXPECT_EQ(choice.patient, "old_f_tear,fat=3.5");
  EXPECT_EQ(with_variant("meshes/arm@fat=3", "tear"), "meshes/arm+tear@fat=3");
  EXPECT_EQ(with_patient("meshes/arm+tear@fat=3", "seed=1"), "meshes/arm+tear@seed=1");
  EXPECT_EQ(with_patient("meshes/arm@fat=3", ""), "meshes/arm");
}

}  // namespace
}  // namespace artus
