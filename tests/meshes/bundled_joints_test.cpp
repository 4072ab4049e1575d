// SPDX-License-Identifier: AGPL-3.0-or-later
// The joint files of the generated joints: valid, and their poses where the anatomy is.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/meshes/generate/ankle.h"
#include "artus/detail/meshes/generate/elbow.h"
#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/leg_measures.h"
#include "artus/detail/meshes/generate/limb_measures.h"
#include "artus/detail/meshes/generate/measures.h"
#include "artus/detail/meshes/generate/scapular_frame.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/shoulder_measures.h"
#include "artus/detail/meshes/generate/simple_shoulder.h"
#include "artus/detail/meshes/generate/wrist.h"
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

TEST(BundledJoints, ElbowWristAndAnklePlaceProbeAndPassesOnTheirLayers) {
  struct Place {
    const char* joint;
    std::vector<Solid> solids;
    const char* target;
    const char* bone;
  };
  for (const Place& place : {Place{"elbow", make_elbow({}), "posterior_recess", "humerus"},
                             Place{"wrist", make_wrist({}), "carpal_tunnel", "pisiform"},
                             Place{"ankle", make_ankle({}), "anterior_recess", "talus"}}) {
    SCOPED_TRACE(place.joint);
    const JointFile joint = read_bundled_joint(place.joint);
    const Field skin = find_solid(place.solids, "body");
    const Vec3 face = joint.X_JP_default->translation();
    EXPECT_NEAR(skin(face), 0, 3e-3) << "a hollow under the face is filled with gel";
    expect_passes(joint, skin, find_solid(place.solids, place.target),
                  find_solid(place.solids, place.bone));
  }
}

// What lies before a structure in the joint's list and in it too is not the structure's.
bool is_in(const std::vector<Solid>& solids, const std::string& name, const Vec3& p) {
  for (const Solid& solid : solids) {
    if (solid.name == "body" || solid.field(p) >= 0) continue;
    return solid.name == name;
  }
  return false;
}

struct OtherPlace {
  const char* joint;
  const std::vector<Solid>& solids;
  const char* target;
};

/// A variant's one planned injection, in the plane of its probe, from the skin and past all bone.
PlannedInjection expect_plan_of_variant(const OtherPlace& place) {
  const JointFile joint = read_bundled_joint(place.joint);
  EXPECT_EQ(joint.injections.size(), 1U);
  const PlannedInjection pass = joint.injections.front();
  EXPECT_NEAR(find_solid(place.solids, "body")(pass.entry), 0, 0.8e-3);
  EXPECT_NEAR((joint.X_JP_default->inverse() * pass.target).y(), 0, 0.5e-3);
  EXPECT_NEAR((joint.X_JP_default->inverse() * pass.entry).y(), 0, 0.5e-3);
  EXPECT_TRUE(joint.X_JN_default->translation().isApprox(pass.target)) << "the needle's plan";
  for (const Structure& s : joint.structures) {
    if (s.tissue != "bone") continue;
    const Field bone = find_solid(place.solids, s.name);
    for (double at = 0; at <= 1; at += 0.05)
      EXPECT_GT(bone(pass.entry + at * (pass.target - pass.entry)), 0) << s.name;
  }
  return pass;
}

TEST(BundledJoints, OtherPlacesOfElbowWristAndAnkleHaveTheirTargetsInThePlane) {
  const std::vector<Solid> elbow = make_elbow({});
  const std::vector<Solid> wrist = make_wrist({});
  const std::vector<Solid> ankle = make_ankle({});
  for (const OtherPlace& place :
       {OtherPlace{"elbow+lateral_epicondyle", elbow, "radiohumeral_bursa"},
        OtherPlace{"elbow+olecranon_bursa", elbow, "olecranon_bursa"},
        OtherPlace{"wrist+first_compartment", wrist, "first_compartment_sheath"},
        OtherPlace{"wrist+radiocarpal", wrist, "radiocarpal_recess"},
        OtherPlace{"ankle+retrocalcaneal", ankle, "retrocalcaneal_bursa"}}) {
    SCOPED_TRACE(place.joint);
    EXPECT_TRUE(is_in(place.solids, place.target, expect_plan_of_variant(place).target));
  }
}

TEST(BundledJoints, DiseasesOfShoulderKneeAndHipBringTheirOwnInjection) {
  const std::vector<Solid> shoulder = make_shoulder({});
  const std::vector<Solid> knee = make_knee({});
  const std::vector<Solid> hip = make_hip({});
  for (const OtherPlace& place :
       {OtherPlace{"shoulder+acromioclavicular", shoulder, "acromioclavicular_cavity"},
        OtherPlace{"shoulder+adhesive_capsulitis", shoulder, "posterior_recess"},
        OtherPlace{"shoulder+effusion", shoulder, "posterior_recess"},
        OtherPlace{"shoulder+calcific_deposit", shoulder, "calcific_deposit"},
        OtherPlace{"shoulder+rotator_interval", shoulder, "peribursal_fat"},
        OtherPlace{"knee+bakers_cyst", knee, "bakers_cyst"},
        OtherPlace{"hip+iliopsoas_bursitis", hip, "iliopsoas_bursa"}}) {
    SCOPED_TRACE(place.joint);
    const PlannedInjection pass = expect_plan_of_variant(place);
    EXPECT_LT(find_solid(place.solids, place.target)(pass.target), -0.3e-3);
  }
}

TEST(BundledJoints, APatientsDiseaseLeavesTheInjectionsThatAreAskedFor) {
  const JointFile joint = read_bundled_joint("shoulder@effusion=1,calcification=1");
  ASSERT_EQ(joint.injections.size(), 3U);
  EXPECT_EQ(joint.injections.front().name, "bursa_over_tendon");
  EXPECT_TRUE(joint.X_JP_default->isApprox(*read_bundled_joint("shoulder").X_JP_default));
}

TEST(BundledJoints, ElbowWristAndAnkleLandmarksLieOnTheirBones) {
  const auto expect_on = [](const char* joint, const std::vector<Solid>& solids,
                            std::initializer_list<std::pair<const char*, const char*>> pairs) {
    for (const auto& [name, bone] : pairs)
      EXPECT_NEAR(find_solid(solids, bone)(landmark(read_bundled_joint(joint), name)), 0, 1.2e-3)
          << name;
  };
  expect_on(
      "elbow", make_elbow({}),
      {{"lateral_epicondyle", "humerus"}, {"medial_epicondyle", "humerus"}, {"olecranon", "ulna"}});
  expect_on(
      "wrist", make_wrist({}),
      {{"radial_styloid", "radius"}, {"lister_tubercle", "radius"}, {"pisiform", "pisiform"}});
  expect_on(
      "ankle", make_ankle({}),
      {{"medial_malleolus", "tibia"}, {"lateral_malleolus", "fibula"}, {"heel", "calcaneus"}});
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
  const Field tendon = subtract(find_solid(solids, "supraspinatus_tendon"),
                                find_solid(solids, "humeral_cartilage"), 0);
  const Field off_bone = subtract(tendon, find_solid(solids, "humerus"), 0);
  const Vec3 up(0, 0, 1);
  double thickness = 0;
  constexpr double kStep = 0.05e-3;
  for (double z = 20e-3; z < 40e-3; z += kStep) {
    if (off_bone(Vec3(0, 1.5e-3, 0) + z * up) < 0) thickness += kStep;
  }
  EXPECT_GT(thickness, 5e-3);
  EXPECT_LT(thickness, 6.2e-3);
}

// Along a line out of the head: where it leaves the last of a solid, m from the middle.
double last_inside(const Field& solid, const Vec3& out) {
  constexpr double kStep = 0.02e-3;
  double last = 0;
  for (double r = 15e-3; r < 45e-3; r += kStep)
    if (solid(r * out) < 0) last = r;
  return last;
}

double length_inside(const Field& solid, const Vec3& out) {
  constexpr double kStep = 0.02e-3;
  double length = 0;
  for (double r = 15e-3; r < 45e-3; r += kStep) length += solid(r * out) < 0 ? kStep : 0;
  return length;
}

TEST(BundledJoints, SupraspinatusTendonThinsToItsFootprintLikeABeakWithoutAStep) {
  const std::vector<Solid> solids = make_shoulder({});
  const Field tendon = find_solid(solids, "supraspinatus_tendon");
  const Field bone = find_solid(solids, "humerus");
  double before = 1;
  double greatest = 0;
  for (double degrees = 30; degrees < 64; degrees += 0.5) {
    const Vec3 out = ScapularFrame::outward(degrees);
    const double over = 1e3 * (last_inside(tendon, out) - last_inside(bone, out));
    if (degrees > 30) {
      EXPECT_LT(std::abs(over - before), 0.6) << degrees;
    }
    before = over;
    greatest = std::max(greatest, over);
  }
  EXPECT_GT(greatest, 5);
  EXPECT_LT(before, 1.5);
}

TEST(BundledJoints, SupraspinatusMuscleRunsOutOverItsTendonWithoutAWall) {
  const std::vector<Solid> solids = make_shoulder({});
  const Field tendon = find_solid(solids, "supraspinatus_tendon");
  const Field belly = find_solid(solids, "supraspinatus");
  const ScapularFrame frame(24e-3);
  int both = 0;
  int tongues = 0;
  for (double u = -4; u < 48; u += 0.5) {
    bool has_tendon = false;
    bool has_muscle = false;
    int changes = 0;
    bool was = false;
    for (double z = 18; z < 36; z += 0.05) {
      const bool in_tendon = tendon(frame.at(u, 2.4, z)) < 0;
      const bool in_muscle = !in_tendon && belly(frame.at(u, 2.4, z)) < 0;
      has_tendon = has_tendon || in_tendon;
      has_muscle = has_muscle || in_muscle;
      changes += in_tendon && !was ? 1 : 0;
      was = in_tendon;
    }
    both += has_tendon && has_muscle ? 1 : 0;
    tongues = std::max(tongues, changes);
  }
  EXPECT_GT(both, 80) << "muscle and tendon lie beside each other for 40 mm and more";
  EXPECT_GE(tongues, 3) << "slips of tendon between bundles";
}

TEST(BundledJoints, BursaIsAtMostOneMillimetreThickWithFatOnBothSides) {
  const std::vector<Solid> solids = make_shoulder({});
  const Field bursa = find_solid(solids, "subacromial_bursa");
  const Field fat = find_solid(solids, "peribursal_fat");
  const Field tendon = find_solid(solids, "supraspinatus_tendon");
  for (double degrees = 10; degrees <= 55; degrees += 5) {
    const Vec3 out = ScapularFrame::outward(degrees);
    const double thickness = length_inside(bursa, out);
    EXPECT_GT(thickness, 0.6e-3) << degrees;
    EXPECT_LT(thickness, 1e-3) << degrees;
    EXPECT_GT(last_inside(fat, out) - last_inside(bursa, out), 0.4e-3) << degrees;
    EXPECT_GT(last_inside(bursa, out) - thickness - last_inside(tendon, out), 0.3e-3) << degrees;
  }
}

// [Groove2024] 3.8 to 6.3 mm deep; [Iannotti1992] the head's top 8 +- 3.2 mm
// above the greater tuberosity.
TEST(BundledJoints, ShoulderHasTheGrooveAndTheTuberosityOfAnAdults) {
  const Field bone = make_humerus({});
  const Vec3 groove = Vec3(-17.2, -20, 0).normalized();
  const auto radius = [&](double degrees) {
    const Vec3 out = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitZ()) * groove;
    double r = 0;
    for (double at = 15e-3; at < 40e-3; at += 0.02e-3)
      if (bone(at * out) < 0) r = at;
    return r;
  };
  double lateral = 0;
  double medial = 0;
  for (double degrees = 2; degrees < 24; degrees += 0.5) {
    lateral = std::max(lateral, radius(degrees));
    medial = std::max(medial, radius(-degrees));
  }
  const double depth = 1e3 * (std::min(lateral, medial) - radius(0));
  EXPECT_GT(depth, 3.8);
  EXPECT_LT(depth, 6.3);
  const ScapularFrame frame(24e-3);
  double top = 0;
  for (double z = 0; z < 24e-3; z += 0.02e-3)
    if (bone(frame.at(-26, 2, 0) + Vec3(0, 0, z)) < 0) top = z;
  EXPECT_NEAR(24 - 1e3 * top, 8, 3.2 + 1);
}

void expect_told(const std::string& joint, const std::vector<Measure>& measures) {
  const auto told =
      read_bytes(artus::test::source_dir() / ("docs/results/" + joint + "-measures.md"));
  ASSERT_TRUE(told) << told.error().to_string();
  EXPECT_EQ(*told, to_markdown(joint, measures))
      << "artus_generate_meshes " << joint << " --measures FILE";
}

TEST(BundledJoints, ShoulderHasLengthsOfAdultsAndTheTableTellsThem) {
  const std::vector<Measure> measures = measure_shoulder({});
  for (const Measure& m : measures) {
    const bool is_known_gap = m.what == "subscapularis tendon over the head";  // 6.3 mm
    EXPECT_EQ(m.is_within(), !is_known_gap) << m.what << ": " << m.value << " mm";
  }
  expect_told("shoulder", measures);
}

TEST(BundledJoints, KneeAndHipHaveLengthsOfAdultsAndTheirTablesTellThem) {
  const std::vector<Measure> knee = measure_knee({});
  const std::vector<Measure> hip = measure_hip({});
  for (const Measure& m : knee) EXPECT_TRUE(m.is_within()) << m.what << ": " << m.value;
  for (const Measure& m : hip) {
    const bool is_full = m.what.ends_with("the recess full");  // 9.2 mm: as drawn, with fluid in it
    EXPECT_EQ(m.is_within(), !is_full) << m.what << ": " << m.value;
  }
  EXPECT_GE(measure_shoulder({}).size() + knee.size() + hip.size(), 20U);
  expect_told("knee", knee);
  expect_told("hip", hip);
}

TEST(BundledJoints, ElbowWristAndAnkleHaveLengthsOfAdultsAndTheirTablesTellThem) {
  const auto expect_within = [](const std::string& joint, const std::vector<Measure>& measures) {
    EXPECT_GE(measures.size(), 10U) << joint;
    for (const Measure& m : measures) EXPECT_TRUE(m.is_within()) << m.what << ": " << m.value;
    expect_told(joint, measures);
  };
  expect_within("elbow", measure_elbow({}));
  expect_within("wrist", measure_wrist({}));
  expect_within("ankle", measure_ankle({}));
}

// What of a line from the front lies in each structure in turn, those before it taking their share.
std::vector<std::string> met_from_the_front(const std::vector<Solid>& solids, const Vec3& from,
                                            const std::vector<std::string>& priority) {
  std::vector<std::string> met;
  for (double t = 0; t < 60e-3; t += 0.05e-3) {
    const Vec3 p = from + Vec3(0, t, 0);
    const auto in = std::find_if(priority.begin(), priority.end(), [&](const std::string& name) {
      return field_of(solids, name)(p) < 0;
    });
    if (in != priority.end() && (met.empty() || met.back() != *in)) met.push_back(*in);
  }
  return met;
}

TEST(BundledJoints, KneesRecessLiesBetweenItsTwoFatPads) {
  const std::vector<std::string> priority{"femur", "suprapatellar_recess", "quadriceps_tendon",
                                          "quadriceps_fat_pad", "prefemoral_fat_pad"};
  const std::vector<std::string> expected{"quadriceps_tendon", "quadriceps_fat_pad",
                                          "suprapatellar_recess", "prefemoral_fat_pad", "femur"};
  EXPECT_EQ(met_from_the_front(make_knee({}), Vec3(-1e-3, -58e-3, 48e-3), priority), expected);
}

TEST(BundledJoints, HipsRecessLiesOnTheNeckUnderTheCapsuleUnderTheMuscle) {
  const std::vector<std::string> priority{"femur", "anterior_recess", "hip_capsule", "iliopsoas"};
  const std::vector<std::string> expected{"iliopsoas", "hip_capsule", "anterior_recess", "femur"};
  EXPECT_EQ(met_from_the_front(make_hip({}), Vec3(-13e-3, -60e-3, -10e-3), priority), expected);
}

TEST(BundledJoints, EverySurfaceFileIsUsedByTheJointFile) {
  for (const char* name :
       {"simple-shoulder", "shoulder", "elbow", "wrist", "hip", "knee", "ankle"}) {
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
