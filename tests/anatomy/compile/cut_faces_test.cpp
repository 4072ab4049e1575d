// SPDX-License-Identifier: AGPL-3.0-or-later
// Where a body was cut and closed there is no skin: for plans, shells and the compiled hull.
#include "artus/detail/anatomy/compile/labels/cut_faces.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/compile/check/joint_check.h"
#include "artus/detail/anatomy/compile/check/plan_check.h"
#include "artus/detail/anatomy/compile/check/plan_ground.h"
#include "artus/detail/anatomy/surfaces/repair.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "tests/anatomy/compile/joint_folder.h"

namespace artus {
namespace {

using test::JointFolder;
using test::kMm;
using testing::HasSubstr;

constexpr double kRadius = 40 * kMm;

/// A ball whose half x < 0 was cut away.
SurfaceMesh make_half_ball() {
  const SurfaceMesh ball = make_sphere(Vec3::Zero(), kRadius);
  std::vector<bool> keep;
  for (const Triangle& t : ball.triangles) keep.push_back(triangle_centre(ball, t).x() > 0);
  return keep_faces(ball, keep);
}

double area_of(const SurfaceMesh& mesh) {
  return surface_area(mesh);
}

TEST(CutFaces, AreThoseThatTheAuthorGives) {
  const auto repaired = repair_surface(make_half_ball());
  ASSERT_TRUE(repaired);
  const auto found = find_cut_faces(make_half_ball(), repaired->mesh);
  const SurfaceMesh cuts = without_cuts(repaired->mesh, found, true);
  EXPECT_EQ(find_given_cuts(repaired->mesh, cuts), found);
  EXPECT_THAT(find_given_cuts(repaired->mesh, {}), testing::Each(0));
}

TEST(CutFaces, AreThoseThatCloseAFlatCut) {
  const SurfaceMesh half = make_half_ball();
  const auto repaired = repair_surface(half);
  ASSERT_TRUE(repaired) << repaired.error().to_string();
  const auto is_cut = find_cut_faces(half, repaired->mesh);
  ASSERT_EQ(is_cut.size(), repaired->mesh.triangles.size());
  const double disc = std::numbers::pi * kRadius * kRadius;
  EXPECT_NEAR(area_of(without_cuts(repaired->mesh, is_cut, true)), disc, 0.15 * disc);
}

TEST(CutFaces, AHoleInTheSkinIsFilledWithSkin) {
  SurfaceMesh ball = make_sphere(Vec3::Zero(), kRadius);
  ball.triangles.erase(ball.triangles.begin() + 200, ball.triangles.begin() + 204);
  const auto repaired = repair_surface(ball);
  ASSERT_TRUE(repaired) << repaired.error().to_string();
  EXPECT_TRUE(find_cut_faces(ball, repaired->mesh).empty());
}

class CutBody : public testing::Test {
 protected:
  CutBody() : folder_("cut-body") {
    EXPECT_TRUE(write_surface(make_half_ball(), folder_.path() / "body.ply", kMm));
    folder_.add_sphere("head", Vec3(20, 0, 0), 8);
  }
  JointFile read(const std::string& plans) {
    std::ofstream(folder_.path() / "joint.toml") << R"(format = 1
name = "half"
units = "mm"
axes = "LPS"
[mesh]
facet_size = 4.0
facet_distance = 0.4
cell_size = 10.0
[body]
file = "body.ply"
filler = "filler"
tissue = "fat"
[[structure]]
name = "head"
tissue = "muscle"
file = "head.ply"
[[structure]]
name = "skin"
tissue = "skin"
shell = {thickness = 3.0}
)" << plans;
    return read_joint(folder_.path()).value();
  }
  JointFolder folder_;
};

TEST_F(CutBody, TakesNoEntryAndNoProbeOnTheCutAndTheMendsWork) {
  JointFile file = read(R"([probe]
position = [0.0, 0.0, 0.0]
direction = [1.0, 0.0, 0.0]
[[injection]]
name = "through_the_cut"
entry = [0.0, 0.0, 5.0]
target = [20.0, 0.0, 0.0]
)");
  const JointCheck check = check_joint(file);
  EXPECT_EQ(check.count(Verdict::refused), 2U);
  EXPECT_THAT(check.findings.at(0).message, HasSubstr("the body was cut and closed"));
  EXPECT_THAT(check.findings.at(1).message, HasSubstr("the body was cut and closed"));
  EXPECT_TRUE(std::any_of(check.findings.begin(), check.findings.end(), [](const Finding& f) {
    return f.what == "body" && f.verdict == Verdict::look &&
           f.message.find("are not skin") != std::string::npos;
  }));
  for (int round = 0; round < 3; ++round)
    for (const PlanProblem& problem : find_plan_problems(file, make_ground(file, check.prepared)))
      for (const PlanMend& mend : problem.mends) {
        if (mend.key == "entry") file.injections[0].entry = mend.value;
        if (mend.key == "position") file.X_JP_default->translation() = mend.value;
        if (mend.key == "direction")
          file.X_JP_default =
              make_pose(file.X_JP_default->translation(), mend.value, Vec3::UnitZ());
      }
  for (const PlanProblem& left : find_plan_problems(file, make_ground(file, check.prepared)))
    ADD_FAILURE() << to_line(left);
}

TEST_F(CutBody, IsCompiledWithSkinWhereItHasSkin) {
  const auto outcome = compile_joint(read(""));
  ASSERT_TRUE(outcome) << outcome.error().to_string();
  const CompiledJoint& joint = outcome->joint;
  double beyond = 0;
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front >= kFirstRegion) continue;
    Vec3 centre = Vec3::Zero();
    for (const auto v : f.vertices) centre += joint.mesh.vertices[v] / 3;
    const Vec3& a = joint.mesh.vertices[f.vertices[0]];
    const double area = (joint.mesh.vertices[f.vertices[1]] - a)
                            .cross(joint.mesh.vertices[f.vertices[2]] - a)
                            .norm() /
                        2;
    if (f.front == kBeyond) beyond += area;
    if (centre.norm() < 0.9 * kRadius) {
      EXPECT_EQ(f.front, kBeyond) << centre.transpose();
    }
    if (centre.x() > 3 * kMm) {
      EXPECT_EQ(f.front, kOutside) << centre.transpose();
    }
  }
  const double disc = std::numbers::pi * kRadius * kRadius;
  EXPECT_NEAR(beyond, disc, 0.1 * disc);
  // Half of a shell of 3 mm in a ball of 40; one that lined the cut had 14 cm3 more.
  const double shell =
      2.0 / 3 * std::numbers::pi * (std::pow(kRadius, 3) - std::pow(kRadius - 3 * kMm, 3));
  EXPECT_NEAR(outcome->report.structures[2].resolved_volume, shell, 0.07 * shell);
  EXPECT_GT(joint.X_JP_default.translation().norm(), 0.9 * kRadius) << "a probe stands on skin";
  EXPECT_THAT(outcome->report.notes, testing::Contains(HasSubstr("are not skin")));
}

}  // namespace
}  // namespace artus
