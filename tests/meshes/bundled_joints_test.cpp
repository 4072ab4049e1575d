// SPDX-License-Identifier: AGPL-3.0-or-later
// The joint files of the generated joints: valid, and their poses where the anatomy is.
#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/simple_shoulder.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

JointFile read_bundled_joint(const char* name) {
  auto joint = read_joint(artus::test::source_dir() / "meshes" / name);
  EXPECT_TRUE(joint) << joint.error().to_string();
  return joint ? *joint : JointFile{};
}

Field find_solid(const std::vector<Solid>& solids, const std::string& name) {
  const auto it =
      std::find_if(solids.begin(), solids.end(), [&](const Solid& s) { return s.name == name; });
  EXPECT_NE(it, solids.end()) << name;
  return it->field;
}

Vec3 landmark(const JointFile& joint, const std::string& name) {
  const auto it = std::find_if(joint.landmarks.begin(), joint.landmarks.end(),
                               [&](const Landmark& l) { return l.name == name; });
  EXPECT_NE(it, joint.landmarks.end()) << name;
  return it == joint.landmarks.end() ? Vec3::Zero() : it->position;
}

void expect_probe_on_skin_facing_inward(const JointFile& joint, const Field& skin) {
  const Vec3 position = joint.X_JP_default->translation();
  const Vec3 inward = joint.X_JP_default->linear().col(2);
  EXPECT_NEAR(skin(position), 0, 0.5e-3);
  EXPECT_LT(skin(position + 5e-3 * inward), -4e-3);
}

void expect_passes(const JointFile& joint, const Field& skin, const Field& bursa,
                   const Field& bone) {
  ASSERT_EQ(joint.injections.size(), 3U);
  for (const PlannedInjection& pass : joint.injections) {
    EXPECT_NEAR(skin(pass.entry), 0, 0.8e-3) << pass.name;
    const Vec3 to_plane = joint.X_JP_default->inverse() * pass.target;
    EXPECT_NEAR(to_plane.y(), 0, 0.5e-3) << pass.name << " leaves the image plane";
  }
  EXPECT_LT(bursa(joint.injections[0].target), -0.3e-3);
  EXPECT_LT(bursa(joint.injections[1].target), -0.3e-3);
  EXPECT_GT((joint.injections[0].target - joint.injections[1].target).norm(), 5e-3);
  EXPECT_LT(bone(joint.injections[2].target), -1e-3);
}

TEST(BundledJoints, SimpleShoulderPlacesProbeAndPassesOnItsLayers) {
  const JointFile joint = read_bundled_joint("simple-shoulder");
  const std::vector<Solid> solids = make_simple_shoulder({});
  const Field bursa_only = subtract(find_solid(solids, "bursa"), find_solid(solids, "tendon"), 0);
  expect_probe_on_skin_facing_inward(joint, find_solid(solids, "skin"));
  expect_passes(joint, find_solid(solids, "skin"), bursa_only, find_solid(solids, "bone"));
}

TEST(BundledJoints, ShoulderPlacesProbeAndPassesOnItsLayers) {
  const JointFile joint = read_bundled_joint("shoulder");
  const std::vector<Solid> solids = make_shoulder({});
  expect_probe_on_skin_facing_inward(joint, find_solid(solids, "body"));
  expect_passes(joint, find_solid(solids, "body"), find_solid(solids, "subacromial_bursa"),
                find_solid(solids, "humerus"));
}

TEST(BundledJoints, KneePlacesProbeAndPassesOnItsLayers) {
  const JointFile joint = read_bundled_joint("knee");
  const std::vector<Solid> solids = make_knee({});
  expect_probe_on_skin_facing_inward(joint, find_solid(solids, "body"));
  expect_passes(joint, find_solid(solids, "body"), find_solid(solids, "suprapatellar_recess"),
                find_solid(solids, "femur"));
}

TEST(BundledJoints, HipPlacesProbeAndPassesOnItsLayers) {
  const JointFile joint = read_bundled_joint("hip");
  const std::vector<Solid> solids = make_hip({});
  expect_probe_on_skin_facing_inward(joint, find_solid(solids, "body"));
  expect_passes(joint, find_solid(solids, "body"), find_solid(solids, "anterior_recess"),
                find_solid(solids, "femur"));
}

TEST(BundledJoints, KneeAndHipLandmarksLieOnTheirBones) {
  const JointFile knee = read_bundled_joint("knee");
  const std::vector<Solid> of_knee = make_knee({});
  EXPECT_NEAR(find_solid(of_knee, "patella")(landmark(knee, "patella_apex")), 0, 1e-3);
  EXPECT_NEAR(find_solid(of_knee, "patella")(landmark(knee, "patella_base")), 0, 1e-3);
  EXPECT_NEAR(find_solid(of_knee, "tibia")(landmark(knee, "tibial_tuberosity")), 0, 1e-3);
  const JointFile hip = read_bundled_joint("hip");
  const Field femur = find_solid(make_hip({}), "femur");
  EXPECT_NEAR(femur(landmark(hip, "femoral_head_centre")), -24e-3, 2e-3);
  EXPECT_NEAR(femur(landmark(hip, "greater_trochanter")), 0, 1e-3);
  EXPECT_NEAR(femur(landmark(hip, "lesser_trochanter")), 0, 1e-3);
}

TEST(BundledJoints, ShoulderLandmarksLieOnTheirBones) {
  const JointFile joint = read_bundled_joint("shoulder");
  const std::vector<Solid> solids = make_shoulder({});
  const Field humerus = find_solid(solids, "humerus");
  const Field scapula = find_solid(solids, "scapula");
  EXPECT_NEAR(humerus(landmark(joint, "greater_tuberosity")), 0, 1e-3);
  EXPECT_NEAR(humerus(landmark(joint, "lesser_tuberosity")), 0, 1e-3);
  EXPECT_NEAR(scapula(landmark(joint, "acromion_lateral_edge")), 0, 1e-3);
  EXPECT_NEAR(scapula(landmark(joint, "coracoid_tip")), 0, 1e-3);
  EXPECT_NEAR(scapula(landmark(joint, "glenoid_centre")), 0, 1e-3);
  EXPECT_LT(find_solid(solids, "biceps_long_tendon")(landmark(joint, "bicipital_groove")), 0);
}

TEST(BundledJoints, SupraspinatusTendonIsFiveToSixMillimetresThickOverTheHead) {
  const std::vector<Solid> solids = make_shoulder({});
  const Field tendon = find_solid(solids, "supraspinatus");
  const Vec3 up(0, 0, 1);
  double thickness = 0;
  constexpr double kStep = 0.05e-3;
  for (double z = 20e-3; z < 40e-3; z += kStep) {
    if (tendon(Vec3(0, 1.5e-3, 0) + z * up) < 0) thickness += kStep;
  }
  EXPECT_GT(thickness, 5e-3);
  EXPECT_LT(thickness, 6.2e-3);
}

TEST(BundledJoints, EverySurfaceFileIsUsedByTheJointFile) {
  for (const char* name : {"simple-shoulder", "shoulder", "knee", "hip"}) {
    const JointFile joint = read_bundled_joint(name);
    std::vector<Structure> all = joint.structures;
    for (const JointVariant& variant : joint.variants) {
      const JointFile other = read_bundled_joint(with_variant(name, variant.name).c_str());
      all.insert(all.end(), other.structures.begin(), other.structures.end());
    }
    for (const auto& entry : std::filesystem::directory_iterator(joint.surface_folder)) {
      const auto uses = [&](const Structure& s) {
        const auto* file = std::get_if<SurfaceFile>(&s.shape);
        return file != nullptr && file->file.filename() == entry.path().filename();
      };
      EXPECT_TRUE(uses(joint.body) || std::any_of(all.begin(), all.end(), uses)) << entry.path();
    }
  }
}

}  // namespace
}  // namespace artus
