// SPDX-License-Identifier: AGPL-3.0-or-later
// The person around a joint: goes on from the joint's own skin, lies where it should, is refused
// with reasons.
#include "artus/detail/anatomy/outside/outside_body.h"

#include <fstream>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/distance_tree.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/units.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

JointFile bundled(const std::string& name) {
  auto joint = read_joint(test::source_dir() / "meshes" / name);
  EXPECT_TRUE(joint) << joint.error().to_string();
  return *joint;
}

OutsideBody person_around(const JointFile& joint) {
  auto body = read_outside(joint);
  EXPECT_TRUE(body) << body.error().to_string();
  EXPECT_NE(*body, nullptr);
  return **body;
}

class PersonAround : public testing::TestWithParam<const char*> {};

TEST_P(PersonAround, GoesOnFromTheJointsOwnSkin) {
  constexpr double kBand = 10e-3;  // m beyond the joint's region
  constexpr double kStep = 4e-3;   // m
  const JointFile joint = bundled(GetParam());
  const OutsideBody body = person_around(joint);
  const DistanceTree skin(body.skin);
  const auto own = read_surface(joint.surface_folder / std::get<SurfaceFile>(joint.body.shape).file,
                                kMillimetre);
  ASSERT_TRUE(own);
  const RegionOfInterest& region = *joint.region_of_interest;
  int near = 0;
  for (const Vec3& p : own->vertices) {
    OutsideBody wider = body;
    if (region.half_extent)
      *wider.hole->half_extent += Vec3::Constant(kBand);
    else
      wider.hole->radius += kBand;
    if (is_in_hole(body, p) || !is_in_hole(wider, p)) continue;
    ++near;
    EXPECT_LT(skin.distance(p, 0.1), kStep) << (1e3 * p).transpose() << " mm";
  }
  EXPECT_GT(near, 20);
}

TEST_P(PersonAround, HoldsItsBonesAndMarksItsSides) {
  const OutsideBody body = person_around(bundled(GetParam()));
  const DistanceTree skin(body.skin);
  EXPECT_LT(body.skin.triangles.size(), 9000U);
  EXPECT_GT(body.landmarks.size(), 12U);
  for (const BodyLandmark& mark : body.landmarks) {
    EXPECT_GT(skin.winding_number(mark.position), 0.5) << mark.name << " lies in the air";
    EXPECT_LT(skin.distance(mark.position, 1), 35e-3) << mark.name << " is too deep to be felt";
  }
  ASSERT_FALSE(body.right.empty());
  ASSERT_FALSE(body.left.empty());
  for (const Vec3& p : body.right) EXPECT_LT(skin.winding_number(p), 0.5);
  EXPECT_LT(body.right.front().x(), body.left.front().x()) << "LPS: the left is at +x";
  EXPECT_FALSE(body.supports.empty());
}

INSTANTIATE_TEST_SUITE_P(Bundled, PersonAround,
                         testing::Values("shoulder", "elbow", "wrist", "hip", "knee", "ankle"),
                         [](const auto& joint) { return std::string(joint.param); });

TEST(OutsideBody, IsTheMirrorImageForAJointOfTheOtherSide) {
  JointFile joint = bundled("knee");
  const OutsideBody right = person_around(joint);
  joint.side = "left";
  const OutsideBody left = person_around(joint);
  ASSERT_EQ(left.skin.vertices.size(), right.skin.vertices.size());
  const Vec3 p = right.skin.vertices[100];
  EXPECT_TRUE(left.skin.vertices[100].isApprox(Vec3(-p.x(), p.y(), p.z())));
  EXPECT_GT(signed_volume(left.skin), 0) << "wound outward";
  EXPECT_LT(left.right.front().x(), left.left.front().x());
}

TEST(OutsideBody, IsAsThickAsThePatient) {
  const JointFile usual = bundled("shoulder");
  const double modelled = signed_volume(person_around(usual).skin);
  const double fat = signed_volume(person_around(bundled("shoulder@fat=16")).skin);
  const double heavy = signed_volume(person_around(bundled("shoulder@bmi=38")).skin);
  EXPECT_GT(fat, 1.1 * modelled);
  EXPECT_GT(heavy, 1.2 * modelled);
}

class OutsideFile : public test::TemporaryFolder {};

TEST_F(OutsideFile, NobodyWhereTheFolderSaysNothingAndAllFaultsAtOnceWhereItIsWrong) {
  JointFile joint = bundled("shoulder");
  joint.folder = folder_;
  const auto nobody = read_outside(joint);
  ASSERT_TRUE(nobody);
  EXPECT_EQ(*nobody, nullptr);
  std::ofstream(folder_ / "outside.toml") << "format = 1\nperson = 'nobody.toml'\nside = 'up'\n"
                                             "origin = [0, 0, 9000]\nhat = 1\n";
  const auto wrong = read_outside(joint);
  ASSERT_FALSE(wrong);
  const std::string said = wrong.error().to_string();
  for (const char* fault : {"side", "origin", "hat"})
    EXPECT_NE(said.find(fault), std::string::npos) << said;
}

}  // namespace
}  // namespace artus
