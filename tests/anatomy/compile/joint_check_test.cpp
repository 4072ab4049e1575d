// SPDX-License-Identifier: AGPL-3.0-or-later
// check and compile say the same of the same joint.
#include "artus/detail/anatomy/compile/check/joint_check.h"

#include <algorithm>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/compile/check/held.h"
#include "tests/anatomy/compile/joint_folder.h"

namespace artus {
namespace {

using test::JointFolder;
using testing::HasSubstr;

constexpr const char* kHead = R"([[structure]]
name = "head"
tissue = "muscle"
file = "head.ply"
)";

class CheckedJoint : public testing::Test {
 protected:
  CheckedJoint() : folder_("checked") {
    folder_.add_sphere("body", Vec3(0, 0, 0), 30);
    folder_.add_sphere("head", Vec3(0, 0, 5), 8);
    folder_.add_bone();
  }
  JointCheck check(const std::string& toml) {
    folder_.write_toml(toml);
    return check_joint(read_joint(folder_.path()).value());
  }
  /// What compile refuses before it begins; "" when it would go on.
  std::string refusal(const std::string& toml) {
    folder_.write_toml(toml);
    JointFile file = read_joint(folder_.path()).value();
    file.cell_size = 1e-9;  // so that what is not refused ends soon, too
    CompileOptions options;
    options.check_plans = true;
    const auto outcome = compile_joint(file, options);
    if (outcome || outcome.error().code != ErrorCode::defective) return "";
    return outcome.error().message;
  }

  JointFolder folder_;
};

TEST_F(CheckedJoint, ThatIsSoundIsUsableAndNotRefusedByCompile) {
  const JointCheck found = check(kHead);
  EXPECT_TRUE(found.usable());
  EXPECT_TRUE(found.findings.empty()) << found.findings.front().message;
  EXPECT_EQ(refusal(kHead), "");
}

TEST_F(CheckedJoint, ASizeThatNoPartOfABodyHasIsRefusedByBothAndTheUnitMendsIt) {
  folder_.add_sphere("head", Vec3(0, 0, 0.005), 0.008);
  const JointCheck found = check(kHead);
  EXPECT_FALSE(found.usable());
  EXPECT_EQ(found.findings.front().verdict, Verdict::refused);
  EXPECT_THAT(found.findings.front().message, HasSubstr("units = \"m\""));
  EXPECT_THAT(refusal(kHead), HasSubstr("not the size of a part of a body"));
  const std::string mended = std::string(kHead) + "units = \"m\"\n";
  EXPECT_TRUE(check(mended).usable());
  EXPECT_EQ(refusal(mended), "");
}

TEST_F(CheckedJoint, ABodyOfMetresReadAsMillimetresIsRefusedByBoth) {
  folder_.add_sphere("body", Vec3(0, 0, 0), 0.9);  // 1.8 m, of a whole body
  folder_.add_sphere("head", Vec3(0, 0, 0.2), 0.4);
  const std::string toml = kHead;
  EXPECT_FALSE(check(toml).usable());
  EXPECT_THAT(refusal(toml), HasSubstr("is not the size of a body; give the unit of its file"));
}

TEST_F(CheckedJoint, CoordinatesThatNoFrameHasAreRefusedByBothAndTheFrameMendsIt) {
  folder_.add_sphere("head", Vec3(1e7, 0, 5), 8);
  EXPECT_FALSE(check(kHead).usable());
  EXPECT_THAT(refusal(kHead), HasSubstr("too far from the origin for any frame of a body"));
  folder_.add_sphere("head", Vec3(0, 0, 5), 8);
  EXPECT_TRUE(check(kHead).usable());
}

TEST_F(CheckedJoint, ASurfaceThatIsThereTwiceCountsOnceAndIsTold) {
  SurfaceMesh twice = make_sphere(Vec3(0, 0, 5 * test::kMm), 8 * test::kMm);
  append_mesh(twice, make_sphere(Vec3(0.1 * test::kMm, 0, 5 * test::kMm), 8 * test::kMm));
  ASSERT_TRUE(write_surface(twice, folder_.path() / "head.ply", test::kMm));
  const JointCheck found = check(kHead);
  EXPECT_TRUE(found.usable());
  ASSERT_EQ(found.count(Verdict::look), 1U);
  EXPECT_THAT(found.findings.front().message, HasSubstr("4.28 cm3 added up, 2.16 cm3 together"));
  EXPECT_NEAR(found.surfaces[1].volume, 2.16e-6, 0.03e-6);
}

TEST_F(CheckedJoint, AllRefusalsComeAtOnceAndFirstAndNothingElseOfThemIsCalledMended) {
  std::ofstream(folder_.path() / "head.ply")
      << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n10 0 0\n0 10 0\n3 0 1 2\n";
  const std::string toml = std::string(kHead) + R"([[injection]]
name = "astray"
entry = [0.0, 0.0, 50.0]
target = [0.0, 0.0, 5.0]
)";
  const JointCheck found = check(toml);
  ASSERT_EQ(found.count(Verdict::refused), 2U);
  EXPECT_EQ(found.findings[0].what, "head");
  EXPECT_EQ(found.findings[1].what, "injection 'astray'");
  EXPECT_GT(found.findings[1].line, 20);
  for (const Finding& f : found.findings)
    EXPECT_FALSE(f.what == "head" && f.verdict == Verdict::mended) << f.message;
  const std::string refused = refusal(toml);
  EXPECT_THAT(refused, HasSubstr("2 problems"));
  EXPECT_THAT(refused, HasSubstr("head: "));
  EXPECT_THAT(refused, HasSubstr("injection 'astray' (line"));
}

TEST_F(CheckedJoint, ABodyInAnotherFrameIsRefusedByBoth) {
  folder_.add_sphere("head", Vec3(500, 0, 0), 8);
  folder_.add_sphere("belly", Vec3(510, 0, 0), 8);
  folder_.add_sphere("femur", Vec3(505, 0, 0), 5);
  const std::string toml = std::string(kHead) +
                           "[[structure]]\nname = \"belly\"\ntissue = \"muscle\"\nfile = "
                           "\"belly.ply\"\n";
  EXPECT_FALSE(check(toml).usable());
  EXPECT_THAT(refusal(toml), HasSubstr("another frame"));
}

TEST(UnheldJoint, IsRefusedByBothAndAnyThatHoldsIsTold) {
  JointFolder folder("unheld");
  folder.add_sphere("body", Vec3(0, 0, 0), 30);
  folder.add_sphere("head", Vec3(0, 0, 5), 8);
  folder.write_toml(kHead);
  const JointSources sources(read_joint(folder.path()).value());
  const JointCheck found = check_joint(sources);
  EXPECT_FALSE(found.usable());
  ASSERT_EQ(found.count(Verdict::refused), 1U);
  EXPECT_EQ(found.findings.front().kind, "unheld");
  EXPECT_THAT(found.findings.front().message, HasSubstr("nothing holds the tissue"));
  CompileOptions options;
  options.check_plans = true;
  const auto compiled = compile_joint(sources, options);
  ASSERT_FALSE(compiled);
  EXPECT_EQ(compiled.error().code, ErrorCode::defective);
  EXPECT_THAT(compiled.error().message, HasSubstr("[region_of_interest]"));
  folder.add_bone();
  folder.write_toml(kHead);
  EXPECT_THAT(check_joint(read_joint(folder.path()).value()).held_by, HasSubstr("bone (femur)"));
  folder.add_sphere("femur", Vec3(400, 0, 0), 5);  // of another scan
  const JointCheck lost = check_joint(read_joint(folder.path()).value());
  EXPECT_EQ(lost.count(Verdict::refused), 2U) << "the bone is lost, and nothing else holds";
}

TEST(UnheldJoint, ARegionOfInterestThatCutsTheBodyHoldsItAndIsTold) {
  JointFolder folder("cut-held");
  folder.add_sphere("body", Vec3(0, 0, 0), 30);
  folder.add_sphere("head", Vec3(0, 0, 5), 8);
  const std::string region =
      std::string(kHead) + "[region_of_interest]\ncentre = [0.0, 0.0, 0.0]\n";
  folder.write_toml(region + "radius = 25.0\n");
  EXPECT_THAT(check_joint(read_joint(folder.path()).value()).held_by,
              HasSubstr("the faces where the body is cut"));
  folder.write_toml(region + "radius = 60.0\n");
  EXPECT_FALSE(check_joint(read_joint(folder.path()).value()).usable()) << "it cuts nothing";
}

}  // namespace
}  // namespace artus
