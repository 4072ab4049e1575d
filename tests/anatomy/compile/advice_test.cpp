// SPDX-License-Identifier: AGPL-3.0-or-later
// Faults that joints of others had, made on balls and boxes: each is named with what would do, and
// doing that does it.
#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/compile/check/joint_check.h"
#include "artus/detail/anatomy/compile/check/misplaced.h"
#include "artus/detail/anatomy/surfaces/repair.h"
#include "tests/anatomy/compile/balls_joint.h"
#include "tests/anatomy/compile/joint_folder.h"

namespace artus {
namespace {

using test::Ball;
using test::BallsJoint;
using test::JointFolder;
using test::kMm;
using testing::HasSubstr;
using testing::Not;

std::vector<Finding> in_other_frames(const std::vector<Ball>& balls) {
  BallsJoint joint(0.06, balls);
  joint.file.tissues = read_bundled_tissues().value();
  return find_other_frames(joint.file, joint.surfaces);
}

const Ball kFemur{"femur", "bone", Vec3(-0.03, 0, 0.02), 0.016};
const Ball kTibia{"tibia", "bone", Vec3(-0.03, 0, -0.02), 0.014};

TEST(OtherFrames, WhatFitsIsNotDoubtedWhereverItLies) {
  EXPECT_TRUE(
      in_other_frames({kFemur, kTibia, {"nerve", "nerve", Vec3(0.03, 0, 0), 0.005}}).empty());
}

TEST(OtherFrames, AMirroredNerveIsNamedWithItsAxisAndDistance) {
  const auto found =
      in_other_frames({kFemur, kTibia, {"nerve", "nerve", Vec3(-0.03, 0, 0.02), 0.004}});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].what, "nerve");
  EXPECT_THAT(found[0].message, HasSubstr("mirrored along x"));
  EXPECT_THAT(found[0].message, HasSubstr("60 mm from here"));
}

TEST(OtherFrames, ASurfaceOfRasAmongLpsIsNamed) {
  BallsJoint joint(0.06, {kFemur, kTibia, {"nerve", "nerve", Vec3(0.025, 0.05, 0), 0.004}});
  // Of the four places that the mistakes lead to, one lies in the body and in no bone.
  joint.surfaces.body = test::prepared(make_sphere(Vec3(-0.03, -0.03, 0), 0.055));
  joint.file.tissues = read_bundled_tissues().value();
  const auto found = find_other_frames(joint.file, joint.surfaces);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].message, HasSubstr("x and y reversed"));
}

class OtherUnits : public testing::TestWithParam<std::pair<double, const char*>> {};
TEST_P(OtherUnits, ABoneOfAnotherUnitIsNamedWithItsNumber) {
  const auto& [factor, words] = GetParam();
  // The patella as it was exported: its coordinates are those of the truth by `factor`.
  const Vec3 truth(0.03, 0, 0);
  Ball patella{"patella", "bone", factor * truth, factor * 0.012};
  std::vector<Ball> balls{{"femur", "bone", Vec3(0, 0, 0), 0.016}, patella};
  balls.push_back({"tibia", "bone", Vec3(0, 0, -0.04), 0.014});
  const auto found = in_other_frames(balls);
  ASSERT_EQ(found.size(), 1U) << factor;
  EXPECT_EQ(found[0].what, "patella");
  EXPECT_THAT(found[0].message, HasSubstr(words));
}
INSTANTIATE_TEST_SUITE_P(Factors, OtherUnits,
                         testing::Values(std::pair{10.0, "10 times too large"},
                                         std::pair{25.4, "25.4 times too large"},
                                         std::pair{0.1, "10 times too small"},
                                         std::pair{1 / 25.4, "25.4 times too small"}));

TEST(PressedBones, APoseThatPushesBoneThroughBoneIsRefusedWithDepthAndPlace) {
  BallsJoint joint(0.06, {{"humerus", "bone", Vec3(0, 0, 0), 0.015},
                          {"scapula", "bone", Vec3(0.03, 0, 0), 0.014}});
  joint.file.tissues = read_bundled_tissues().value();
  JointPose pose;
  pose.name = "forced";
  BoneMotion motion;
  motion.structure = "humerus";
  motion.X_J.translation() = Vec3(0, 0.004, 0);  // beside it: 1 mm becomes 0.7 mm
  pose.motions = {motion};
  joint.file.poses = {pose};
  EXPECT_TRUE(find_pressed_bones(joint.file, joint.surfaces).empty());
  joint.file.poses[0].motions[0].X_J.translation() = Vec3(0.006, 0, 0);
  const auto found = find_pressed_bones(joint.file, joint.surfaces);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].verdict, Verdict::refused);
  EXPECT_EQ(found[0].what, "forced");
  EXPECT_THAT(found[0].message,
              testing::ContainsRegex("'humerus' is pressed [45]\\.[0-9] mm into"));
  joint.file.poses[0].motions[0].X_J.translation() = Vec3(0.0015, 0, 0);  // less: it does
  EXPECT_TRUE(find_pressed_bones(joint.file, joint.surfaces).empty());
}

/// A ball, and far from it an open box that nobody can close.
SurfaceMesh ball_and_open_box() {
  SurfaceMesh both = make_sphere(Vec3::Zero(), 6 * kMm);
  SurfaceMesh box = make_cube(Vec3(0, 0, 90 * kMm), 25 * kMm);
  box.triangles.erase(box.triangles.begin() + 2, box.triangles.begin() + 6);  // two sides of six
  append_mesh(both, box);
  return both;
}

class AdviceFolder : public testing::Test {
 protected:
  AdviceFolder() : folder_("advice") {
    folder_.add_sphere("body", Vec3(0, 0, 0), 20);
    folder_.add_bone();
  }
  Result<CompileOutcome> compile(const std::string& toml, bool plans = false) {
    folder_.write_toml(toml);
    const auto file = read_joint(folder_.path());
    ARTUS_TRY(file);
    CompileOptions options;
    options.check_plans = plans;
    return compile_joint(*file, options);
  }
  JointFolder folder_;
};

TEST_F(AdviceFolder, ADefectBeyondTheRegionIsCutAwayAndAboutThatNothingIsRefused) {
  ASSERT_TRUE(write_surface(ball_and_open_box(), folder_.path() / "muscle.ply", kMm));
  const std::string muscle =
      "[[structure]]\nname = \"muscle\"\ntissue = \"muscle\"\nfile = \"muscle.ply\"\n";
  const std::string region = "[region_of_interest]\ncentre = [0.0, 0.0, 0.0]\nradius = 18.0\n";
  const auto refused = compile(muscle);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("muscle"));
  const auto cut = compile(region + muscle);
  ASSERT_TRUE(cut) << cut.error().to_string();
  const StructureReport& report = cut->report.structures[1];
  EXPECT_THAT(report.repairs.at(0), HasSubstr("10 mm outside of the region of interest"));
  EXPECT_NEAR(report.resolved_volume, test::ball_volume(6 * kMm),
              0.05 * test::ball_volume(6 * kMm));
}

TEST_F(AdviceFolder, AWrapOfPlatesIsMadeAndItsDistanceTold) {
  // A box of six plates that do not touch: the body that they stand around.
  SurfaceMesh box = make_cube(Vec3::Zero(), 8 * kMm);
  SurfaceMesh plates;
  for (std::size_t side = 0; side + 1 < box.triangles.size(); side += 2) {
    SurfaceMesh plate;
    plate.vertices = box.vertices;
    plate.triangles = {box.triangles[side], box.triangles[side + 1]};
    Vec3 middle = Vec3::Zero();
    for (const Triangle& t : plate.triangles) middle += triangle_centre(plate, t) / 2;
    for (Vec3& p : plate.vertices) p = middle + 0.8 * (p - middle);
    append_mesh(plates, plate);
  }
  RepairOptions options;
  EXPECT_FALSE(repair_surface(plates, options)) << "plates enclose nothing by themselves";
  options.wrap = WrapPolicy::always;
  const auto wrapped = repair_surface(plates, options);
  ASSERT_TRUE(wrapped) << wrapped.error().to_string();
  EXPECT_GT(wrapped->volume, 0.8 * 4.1e-6);
  EXPECT_LT(wrapped->volume, 1.4 * 4.1e-6);
  ASSERT_FALSE(wrapped->actions.empty());
  EXPECT_EQ(wrapped->actions.back().kind, RepairKind::wrapped);
  EXPECT_THAT(wrapped->actions.back().message, HasSubstr("mm away in the mean"));
}

TEST_F(AdviceFolder, AStructureOfWhichNothingIsLeftIsRefusedAndItsPlaceInTheFileMendsIt) {
  folder_.add_sphere("vastus", Vec3(0, 0, 6), 9);
  folder_.add_sphere("nerve", Vec3(0, 0, 6), 3);
  const std::string vastus =
      "[[structure]]\nname = \"vastus\"\ntissue = \"muscle\"\nfile = \"vastus.ply\"\n";
  const std::string nerve =
      "[[structure]]\nname = \"nerve\"\ntissue = \"nerve\"\nfile = \"nerve.ply\"\n";
  folder_.write_toml(vastus + nerve);
  const auto file = read_joint(folder_.path());
  ASSERT_TRUE(file);
  const JointCheck check = check_joint(*file);
  EXPECT_FALSE(check.usable());
  const auto refused = compile(vastus + nerve, true);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("put it before 'vastus'"));
}

TEST_F(AdviceFolder, WhatConstructsTakeAllButALittleOfIsRefusedWithTheTaker) {
  // The dermis is no surface that check could look into: only the compiled labels tell.
  folder_.add_sphere("body", Vec3(0, 0, 0), 30);
  folder_.add_sphere("nerve", Vec3(28.5, 0, 0), 1.2);
  const std::string skin =
      "[[structure]]\nname = \"dermis\"\ntissue = \"skin\"\nshell = { thickness = 2.5 "
      "}\n";
  const std::string nerve =
      "[[structure]]\nname = \"nerve\"\ntissue = \"nerve\"\nfile = \"nerve.ply\"\n";
  const auto refused = compile(skin + nerve, true);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("'dermis' stands before it and takes it"));
  const auto mended = compile(nerve + skin, true);
  EXPECT_TRUE(mended) << mended.error().to_string();
}

TEST_F(AdviceFolder, ARecessIsNeverToldToStandBeforeItsFloorAndTheAdviceKeepsTheBone) {
  folder_.add_sphere("roof", Vec3(0, 0, 38), 39);
  folder_.add_sphere("floor", Vec3(0, 0, -41), 40.05);
  const auto walls = [](bool gap_first, double thickness) {
    const std::string gap =
        "[[structure]]\nname = \"recess\"\ntissue = \"bursa\"\ngap = { roof = "
        "[\"roof\"], floor = [\"floor\"], thickness = " +
        std::to_string(thickness) + ", within = 6.0, centre = [0.0, 0.0, -1.0], radius = 8.0 }\n";
    const std::string bone =
        "[[structure]]\nname = \"floor\"\ntissue = \"bone\"\nfile = \"floor.ply\"\n";
    return (gap_first ? gap + bone : bone + gap) +
           "[[structure]]\nname = \"roof\"\ntissue = \"muscle\"\nfile = \"roof.ply\"\n";
  };
  const auto report_of = [](const CompileOutcome& outcome, const std::string& name) {
    for (const StructureReport& r : outcome.report.structures)
      if (r.name == name) return r;
    return StructureReport{};
  };
  const auto first = compile(walls(false, 1.5));
  ASSERT_TRUE(first) << first.error().to_string();
  const StructureReport recess = report_of(*first, "recess");
  ASSERT_FALSE(recess.warnings.empty());
  EXPECT_THAT(recess.warnings[0], HasSubstr("its own wall 'floor'"));
  EXPECT_THAT(recess.warnings[0], HasSubstr("double its 'thickness'"));
  EXPECT_THAT(recess.warnings[0], Not(HasSubstr("put")));
  const auto followed = compile(walls(false, 3));
  ASSERT_TRUE(followed);
  EXPECT_GT(report_of(*followed, "recess").resolved_volume, 1.5 * recess.resolved_volume);
  EXPECT_NEAR(report_of(*followed, "floor").resolved_volume,
              report_of(*first, "floor").resolved_volume, 0.01e-6);
  // The other way round the bone gives, and that is said, however little it is of the bone.
  const auto wrong = compile(walls(true, 1.5));
  ASSERT_TRUE(wrong);
  const StructureReport bone = report_of(*wrong, "floor");
  ASSERT_FALSE(bone.warnings.empty());
  EXPECT_THAT(bone.warnings[0], HasSubstr("of this bone goes to 'recess'"));
  EXPECT_THAT(bone.warnings[0], HasSubstr("put the bone before it"));
}

TEST_F(AdviceFolder, CartilageAsFloorDoesNotHalveARecessUnsaidAndTheAdviceMendsIt) {
  folder_.add_sphere("roof", Vec3(0, 0, 40), 40);
  folder_.add_sphere("floor", Vec3(0, 0, -43), 40);
  folder_.add_sphere("cartilage", Vec3(0, 0, -43), 42.9);
  const auto structure = [](const std::string& name, const std::string& tissue) {
    return "[[structure]]\nname = \"" + name + "\"\ntissue = \"" + tissue + "\"\nfile = \"" + name +
           ".ply\"\n";
  };
  const auto joint = [&](const std::string& thickness) {
    return structure("floor", "bone") + structure("cartilage", "cartilage") +
           "[[structure]]\nname = \"recess\"\ntissue = \"synovial_fluid\"\ngap = { roof = "
           "[\"roof\"], "
           "floor = [\"floor\", \"cartilage\"], thickness = " +
           thickness + ", within = 6.0, centre = [0.0, 0.0, 0.0], radius = 8.0 }\n" +
           structure("roof", "muscle");
  };
  const auto report_of = [](const CompileOutcome& outcome, const std::string& name) {
    for (const StructureReport& r : outcome.report.structures)
      if (r.name == name) return r;
    return StructureReport{};
  };
  const auto first = compile(joint("1.5"));
  ASSERT_TRUE(first) << first.error().to_string();
  const StructureReport recess = report_of(*first, "recess");
  ASSERT_FALSE(recess.warnings.empty());
  EXPECT_THAT(recess.warnings[0], HasSubstr("its own wall 'cartilage'"));
  EXPECT_TRUE(recess.is_changed()) << "the table marks it";
  const auto followed = compile(joint("3.0"));
  ASSERT_TRUE(followed) << followed.error().to_string();
  EXPECT_GT(report_of(*followed, "recess").resolved_volume, 1.4 * recess.resolved_volume);
  EXPECT_NEAR(report_of(*followed, "cartilage").resolved_volume,
              report_of(*first, "cartilage").resolved_volume, 0.02e-6);
}

}  // namespace
}  // namespace artus
