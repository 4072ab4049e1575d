// SPDX-License-Identifier: AGPL-3.0-or-later
// The real shoulder's joint file against its surfaces, where those are at hand.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/surfaces/distance_tree.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/units.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

const std::filesystem::path kFolder = artus::test::source_dir() / "meshes" / "real-shoulder";

std::filesystem::path find_surfaces() {
  const char* shared = std::getenv("ARTUS_SHARED");
  const std::filesystem::path root =
      shared != nullptr ? shared : artus::test::source_dir() / ".." / "shared";
  return root / "data" / "shoulder";
}

class RealShoulder : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(find_surfaces())) GTEST_SKIP() << "the surfaces are not here";
    auto joint = read_joint(kFolder, find_surfaces());
    ASSERT_TRUE(joint) << joint.error().to_string();
    joint_ = std::move(*joint);
  }

  static DistanceTree tree(const char* file) {
    const auto mesh = read_surface(find_surfaces() / file, kMillimetre);
    EXPECT_TRUE(mesh) << mesh.error().to_string();
    return DistanceTree(mesh ? *mesh : SurfaceMesh{});
  }

  JointFile joint_;
};

TEST_F(RealShoulder, HasAtLeastTwentyFiveStructuresAndAllTheirFiles) {
  EXPECT_GE(joint_.structures.size(), 25U);
  for (const Structure& s : joint_.structures) {
    const auto* surface = std::get_if<SurfaceFile>(&s.shape);
    if (surface == nullptr) continue;
    EXPECT_TRUE(std::filesystem::exists(joint_.surface_folder / surface->file)) << s.name;
  }
}

TEST_F(RealShoulder, ProbeAndNeedleStartOnTheSkin) {
  const DistanceTree skin = tree("s_skin_outer.ply");
  EXPECT_LT(skin.distance(joint_.X_JP_default->translation(), 0.1), 0.5e-3);
  for (const PlannedInjection& pass : joint_.injections) {
    EXPECT_LT(skin.distance(pass.entry, 0.1), 0.8e-3) << pass.name;
  }
}

TEST_F(RealShoulder, FirstTwoPassesEndBetweenDeltoidAndCuffAndTheThirdInBone) {
  const DistanceTree deltoid = tree("m_deltoid_acromial.ply");
  const DistanceTree cuff = tree("m_supraspinatus.ply");
  const DistanceTree humerus = tree("b_humerus.ply");
  ASSERT_EQ(joint_.injections.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 target = joint_.injections.at(i).target;
    EXPECT_LT(deltoid.distance(target, 0.1) + cuff.distance(target, 0.1), 5e-3) << i;
    EXPECT_LT(humerus.winding_number(target), 0.5) << i;
  }
  EXPECT_GT(humerus.winding_number(joint_.injections[2].target), 0.5);
}

TEST_F(RealShoulder, TendonsInsertOnTheirBone) {
  for (const Structure& s : joint_.structures) {
    const auto* end = std::get_if<EndConstruct>(&s.shape);
    if (end == nullptr || !end->insertion) continue;
    const DistanceTree bone = tree(end->toward == "humerus" ? "b_humerus.ply" : "b_scapula.ply");
    EXPECT_LT(bone.distance(*end->insertion, 0.1), 6e-3) << s.name;
  }
}

}  // namespace
}  // namespace artus
