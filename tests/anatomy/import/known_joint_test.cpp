// SPDX-License-Identifier: AGPL-3.0-or-later
// A joint whose surfaces are an atlas's, found by number, name and place in files as they come.
#include "artus/detail/anatomy/import/atlas/known_joint.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/import/atlas/atlas_frame.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "tests/anatomy/surfaces/surface_samples.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::HasSubstr;

constexpr const char* kJoint = R"(format = 1
name = "made-up"
side = "right"
[region_of_interest]
centre = [-100, 20, 300]
radius = 40
[body]
file = "skin.ply"
filler = "fat"
)";

constexpr const char* kSources = R"(credits = ["An atlas, by its authors"]
[skin]
file = "skin.ply"
names = ["Region of the arm", "Region of the back"]
[[surface]]
file = "b_humerus.ply"
fma = 23130
names = ["Humerus"]
box = [[-110, 10, 290], [-90, 30, 310]]
[[surface]]
file = "m_deltoid.ply"
fma = 99
names = ["Deltoid"]
box = [[-140, 0, 300], [-120, 20, 320]]
)";

SurfaceMesh cube_mm(double x, double y, double z, double half = 10) {
  return make_cube(Vec3(x, y, z) * kMillimetre, half * kMillimetre);
}

class KnownJointTest : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    std::filesystem::create_directories(folder_ / "joint");
    std::filesystem::create_directories(folder_ / "atlas");
    ASSERT_TRUE(write_text(folder_ / "joint/joint.toml", kJoint));
    ASSERT_TRUE(write_text(folder_ / "joint/sources.toml", kSources));
  }
  void put(SurfaceMesh mesh, const std::string& name, const AtlasFrame& to_file = {}) const {
    for (Vec3& p : mesh.vertices) p = to_file.apply(p);
    ASSERT_TRUE(write_surface(mesh, folder_ / "atlas" / name, kMillimetre));
  }
  [[nodiscard]] Result<FoundJoint> find() const {
    const auto joint = read_known_joint(folder_ / "joint");
    if (!joint) return tl::make_unexpected(joint.error());
    return find_known_joint(*joint, {folder_ / "atlas"}, kMillimetre);
  }
  void put_plates() const {
    put(cube_mm(-100, -20, 300, 5), "Region_of_the_arm_r.stl");
    put(cube_mm(-100, 60, 300, 5), "Region of the back.l.stl");
    put(cube_mm(900, 60, 300, 5), "Region of the back.r.stl");
  }
};

Vec3 lowest(const SurfaceMesh& mesh) {
  Vec3 low = mesh.vertices.front();
  for (const Vec3& p : mesh.vertices) low = low.cwiseMin(p);
  return low / kMillimetre;
}

TEST_F(KnownJointTest, SurfacesAreFoundByNumberAndByNameAndPlatesByTheirRegion) {
  put(cube_mm(-100, 20, 300), "FJ757_BP62907_FMA23130_Right_humerus.ply");
  put(cube_mm(-100, 20, 300), "FMA231301.ply");
  put(cube_mm(100, 20, 300), "Deltoid_muscle_l.stl");
  put(cube_mm(-130, 10, 310), "Deltoid_muscle_r.stl");
  put_plates();
  ASSERT_TRUE(write_text(folder_ / "atlas/readme.txt", "no surface"));
  const auto found = find();
  ASSERT_TRUE(found) << found.error().to_string();
  ASSERT_EQ(found->surfaces.size(), 3U);
  EXPECT_EQ(found->surfaces[0].by, "FMA23130");
  EXPECT_EQ(found->surfaces[1].source, "Deltoid_muscle_r.stl");
  EXPECT_TRUE(found->skin_is_plates);
  EXPECT_EQ(found->surfaces[2].mesh.triangles.size(), 24U) << "the far plate is left out";
  EXPECT_TRUE(found->notes.empty());

  const auto joint = read_known_joint(folder_ / "joint");
  ASSERT_TRUE(write_known_joint(*joint, *found, folder_ / "out", false));
  EXPECT_THAT(*read_bytes(folder_ / "out/joint.toml"),
              HasSubstr("file = \"skin.ply\"\nrepair = \"wrap\"\n"));
  EXPECT_THAT(*read_bytes(folder_ / "out/CREDITS.txt"), HasSubstr("by its authors"));
  const auto humerus = read_surface(folder_ / "out/surfaces/b_humerus.ply", kMillimetre);
  ASSERT_TRUE(humerus);
  EXPECT_LT((lowest(*humerus) - Vec3(-110, 10, 290)).norm(), 1e-9);
  const auto again = write_known_joint(*joint, *found, folder_ / "out", false);
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("--replace"));
}

TEST_F(KnownJointTest, FilesThatHaveTheJointsOwnNamesAreTakenTogetherWithItsClosedSkin) {
  put(cube_mm(-100, 20, 300), "b_humerus.ply");
  put(cube_mm(-130, 10, 310), "m_deltoid.ply");
  put(cube_mm(-100, 20, 300, 60), "skin.ply");
  const auto found = find();
  ASSERT_TRUE(found) << found.error().to_string();
  ASSERT_EQ(found->surfaces.size(), 3U);
  EXPECT_EQ(found->surfaces[1].by, "the joint's own name");
  EXPECT_FALSE(found->skin_is_plates);
}

TEST_F(KnownJointTest, UnitAndAxesOfAFileAreThoseInWhichItsSurfacesLieWhereTheyAreKnown) {
  AtlasFrame from_lps;  // a file in metres with y up: (x, z, -y) / 1000
  from_lps.scale = 1e-3;
  from_lps.turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  put(cube_mm(-100, 20, 300), "FMA23130.obj", from_lps);
  put(cube_mm(-130, 10, 310), "FMA99.ply", {1.0 / 27.66, Eigen::Matrix3d::Identity()});
  put_plates();
  const auto found = find();
  ASSERT_TRUE(found) << found.error().to_string();
  EXPECT_LT((lowest(found->surfaces[0].mesh) - Vec3(-110, 10, 290)).norm(), 1e-3);
  EXPECT_LT((lowest(found->surfaces[1].mesh) - Vec3(-140, 0, 300)).norm(), 1e-3);
  ASSERT_EQ(found->notes.size(), 2U);
  EXPECT_THAT(found->notes[0], HasSubstr("FMA23130.obj: times 1000, x y z from x -z y"));
  EXPECT_THAT(found->notes[1], HasSubstr("times 27.66"));
}

TEST_F(KnownJointTest, WhatIsMissingAndWhatIsAnotherBodyIsRefusedWithBoth) {
  put(cube_mm(-100, 20, 300), "FMA23130.ply");
  const auto missing = find();
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  EXPECT_THAT(missing.error().message, HasSubstr("2 of 3 surfaces"));
  EXPECT_THAT(missing.error().message, HasSubstr("m_deltoid.ply: Deltoid (FMA99)"));
  put(cube_mm(-170, 10, 310), "FMA99.ply");
  put_plates();
  const auto other = find();
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::invalid);
  EXPECT_THAT(other.error().message, HasSubstr("(-180, 0, 300) to (-160, 20, 320) mm"));
  EXPECT_THAT(other.error().message, HasSubstr("(-140, 0, 300) to (-120, 20, 320) mm"));
}

TEST_F(KnownJointTest, OfTwoThatFitTheNearerIsTaken) {
  put(cube_mm(-98, 20, 300), "FMA23130.ply");
  put(cube_mm(-100, 20, 300.5), "Humerus.r.stl");
  put(cube_mm(-130, 10, 310), "FMA99.ply");
  put_plates();
  const auto found = find();
  ASSERT_TRUE(found) << found.error().to_string();
  EXPECT_EQ(found->surfaces[0].source, "Humerus.r.stl");
  ASSERT_EQ(found->notes.size(), 1U);
  EXPECT_THAT(found->notes[0], HasSubstr("b_humerus.ply is there twice"));
}

TEST_F(KnownJointTest, ATableThatIsWrongIsRefusedWithItsPlace) {
  ASSERT_TRUE(write_text(folder_ / "joint/sources.toml",
                         "credits = [\"a\"]\n[[surface]]\nfile = \"a.ply\"\nnames = [\"a\"]\n"
                         "box = [[1, 2, 3], [0, 3, 4]]\n"));
  const auto joint = read_known_joint(folder_ / "joint");
  ASSERT_FALSE(joint);
  EXPECT_THAT(joint.error().to_string(), HasSubstr("the lower first"));
  const auto none = read_known_joint(folder_ / "atlas");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::not_found);
}

TEST(AtlasFrame, IsThatOfMostBoxesWhateverTheRest) {
  AtlasFrame to_file;
  to_file.scale = 100;
  to_file.turn << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  std::vector<KnownBox> boxes;
  for (int k = 0; k < 4; ++k) {
    const Vec3 low(0.1 + 0.01 * k, -0.2, 0.3 * k);
    const Eigen::AlignedBox3d known(low, low + Vec3(0.02, 0.05, 0.03 + 0.01 * k));
    boxes.push_back({known, to_file.apply(known), 1e-3});
  }
  boxes[1].found.translate(Vec3(30, 0, 0));
  const auto frame = find_atlas_frame(boxes);
  ASSERT_TRUE(frame);
  EXPECT_DOUBLE_EQ(frame->scale, 0.01);
  EXPECT_TRUE((frame->turn * to_file.turn).isIdentity(0));
  EXPECT_LT(corners_apart(*frame, boxes[0]), 1e-12);
  EXPECT_GT(corners_apart(*frame, boxes[1]), 0.1);
}

/// The bundled table against the real surfaces under an atlas's names, where they are at hand.
TEST_F(KnownJointTest, TheRealShoulderIsMadeOfItsAtlasesFiles) {
  const auto real = real_shoulder_folder();
  if (real.empty()) GTEST_SKIP() << "no real surfaces here";
  const auto joint = read_known_joint(test::source_dir() / "meshes/real-shoulder");
  ASSERT_TRUE(joint) << joint.error().to_string();
  AtlasFrame to_web;
  to_web.turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  for (const KnownSurface& s : joint->surfaces) {
    const auto mesh = read_surface(real / s.file, kMillimetre);
    ASSERT_TRUE(mesh) << s.file;
    if (s.fma > 0)
      put(*mesh, "FMA" + std::to_string(s.fma) + ".stl");
    else
      put(*mesh, s.names.front() + ".r.ply", to_web);
  }
  const auto skin = read_surface(real / joint->skin_file, kMillimetre);
  ASSERT_TRUE(skin);
  put(*skin, "FMA7163.stl");
  const auto found = find_known_joint(*joint, {folder_ / "atlas"}, kMillimetre);
  ASSERT_TRUE(found) << found.error().to_string();
  EXPECT_EQ(found->surfaces.size(), joint->surfaces.size() + 1);
  EXPECT_FALSE(found->skin_is_plates);
}

}  // namespace
}  // namespace artus
