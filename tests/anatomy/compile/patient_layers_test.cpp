// SPDX-License-Identifier: AGPL-3.0-or-later
// A patient's layers in the compiled body: concentric balls, bone 10, muscle 20, body 28 mm.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/anatomy/body/skin_line.h"
#include "artus/detail/anatomy/compile/labels/grown_field.h"
#include "tests/anatomy/compile/joint_folder.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using test::JointFolder;
using test::kMm;

constexpr const char* kLayers = R"(
[parameter.fat]
title = "fat"
unit = "mm"
modelled = 8.0
least = 1.0
most = 20.0
acts = [{ key = "body.grow", per = 1.0 }]
[parameter.muscle]
title = "muscle"
unit = "mm"
modelled = 10.0
least = 5.0
most = 20.0
acts = [{ key = "structure.muscle.grow", per = 1.0 }, { key = "body.grow", per = 1.0 }]
[[structure]]
name = "bone"
tissue = "bone"
file = "bone.ply"
[[structure]]
name = "muscle"
tissue = "muscle"
file = "muscle.ply"
)";

class PatientLayers : public testing::Test {
 protected:
  PatientLayers() : folder_("patient") {
    folder_.add_sphere("body", Vec3(0, 0, 0), 28);
    folder_.add_sphere("bone", Vec3(0, 0, 0), 10);
    folder_.add_sphere("muscle", Vec3(0, 0, 0), 20);
    folder_.write_toml(kLayers);
    options_.cache = folder_.path() / "cache";
  }
  CompiledJoint compile(const std::string& patient) {
    auto joint = load_joint(with_patient(folder_.path(), patient), options_);
    EXPECT_TRUE(joint) << joint.error().to_string();
    return std::move(*joint);
  }

  JointFolder folder_;
  LoadOptions options_;
};

/// Least and greatest distance from the middle of the vertices between two regions.
std::pair<double, double> radii(const CompiledJoint& joint, RegionId a, RegionId b) {
  double least = 1;
  double most = 0;
  for (const Interface& f : joint.mesh.interfaces) {
    if (std::minmax(f.front, f.back) != std::minmax(a, b)) continue;
    for (const std::uint32_t v : f.vertices) {
      least = std::min(least, joint.mesh.vertices[v].norm());
      most = std::max(most, joint.mesh.vertices[v].norm());
    }
  }
  return {least, most};
}

void expect_radius(const CompiledJoint& joint, RegionId a, RegionId b, double expected) {
  constexpr double kFacetDistance = 0.2 * kMm;  // of the test's joint file
  const auto [least, most] = radii(joint, a, b);
  EXPECT_NEAR(least, expected, kFacetDistance);
  EXPECT_NEAR(most, expected, kFacetDistance);
}

TEST_F(PatientLayers, AreAsThickAsThePatientSays) {
  for (const auto& [fat, muscle] : {std::pair{8.0, 10.0}, {14.0, 10.0}, {3.0, 15.5}, {4.0, 6.0}}) {
    SCOPED_TRACE(fat);
    const CompiledJoint joint =
        compile("fat=" + std::to_string(fat) + ",muscle=" + std::to_string(muscle));
    const RegionId bone = find_region(joint, "bone").value();
    const RegionId flesh = find_region(joint, "muscle").value();
    expect_radius(joint, bone, flesh, 10 * kMm);
    expect_radius(joint, flesh, kFirstRegion, (10 + muscle) * kMm);
    expect_radius(joint, kFirstRegion, kOutside, (10 + muscle + fat) * kMm);
  }
}

TEST_F(PatientLayers, OnlyTheSideThatFacesTheSkinMoves) {
  // A muscle beside the bone: its inner face stays where no bone is.
  folder_.add_sphere("muscle", Vec3(0, 0, 14), 8);
  const auto span = [](const CompiledJoint& joint) {
    const RegionId flesh = find_region(joint, "muscle").value();
    double low = 1;
    double high = 0;
    for (const Interface& f : joint.mesh.interfaces)
      for (const std::uint32_t v : f.vertices) {
        if (f.front != flesh && f.back != flesh) continue;
        const Vec3& p = joint.mesh.vertices[v];
        if (std::hypot(p.x(), p.y()) > 2 * kMm) continue;
        low = std::min(low, p.z());
        high = std::max(high, p.z());
      }
    return std::pair{low, high};
  };
  const auto [low, high] = span(compile("muscle=10"));
  const auto [low_thick, high_thick] = span(compile("muscle=13"));
  EXPECT_NEAR(low_thick, low, 0.4 * kMm);
  EXPECT_NEAR(high_thick - high, 3 * kMm, 0.4 * kMm);
}

TEST_F(PatientLayers, ProbeAndEntriesFollowTheSkin) {
  const CompiledJoint joint = compile("fat=14");
  EXPECT_NEAR(joint.X_JP_default.translation().norm(), 34 * kMm, 0.3 * kMm);
  EXPECT_NEAR(*find_skin_along(joint, Vec3(0, 0, 30 * kMm), Vec3(0, 0, -1)), -4 * kMm, 0.3 * kMm);
  EXPECT_FALSE(find_skin_along(joint, Vec3(0, 0.1, 0), Vec3(0, 0, -1)));
  const CompiledJoint modelled = compile("");
  EXPECT_EQ(modelled.X_JP_default.translation(), Vec3(0, 0, 30 * kMm));  // as the file says
}

TEST_F(PatientLayers, OneBodyIsCompiledOnceAndIsTheSameBytesAgain) {
  const auto written = [&](const CompiledJoint& joint) {
    const auto file = folder_.path() / "out.artus";
    EXPECT_TRUE(write_compiled_joint(joint, file));
    return test::bytes_of(file);
  };
  const auto bodies = [&] {
    return std::count_if(std::filesystem::directory_iterator(options_.cache), {},
                         [](const auto& entry) { return entry.path().extension() == ".artus"; });
  };
  const std::string first = written(compile("fat=14"));
  EXPECT_EQ(bodies(), 1);
  EXPECT_EQ(written(compile("fat=14")), first);
  EXPECT_EQ(bodies(), 1);
  EXPECT_NE(written(compile("fat=9")), first);
  EXPECT_EQ(bodies(), 2);
  options_.cache = folder_.path() / "other";
  EXPECT_EQ(written(compile("fat=14")), first);
  const auto name = read_joint(with_patient(folder_.path(), "seed=3"))->name;
  EXPECT_EQ(read_joint(with_patient(folder_.path(), name.substr(name.find('@') + 1)))->name, name);
}

TEST(GrownField, ABallMovedAlongTheSkinsNormalCoversTheWayOfItsOuterHalf) {
  // Skin: a ball of 40 mm whose top is at z = 0. In it a ball of 3 mm, 8 mm deep.
  const Box box{Vec3::Constant(-15 * kMm), Vec3::Constant(15 * kMm)};
  const FieldSampling sampling{box, 0.5 * kMm, 14 * kMm};
  const auto field_of = [&](const Vec3& centre, double radius) {
    return DistanceField::compute(DistanceTree(make_sphere(centre * kMm, radius * kMm)), sampling);
  };
  const DistanceField skin = field_of(Vec3(0, 0, -40), 40);
  const DistanceField ball = field_of(Vec3(0, 0, -8), 3);
  const DistanceField thick = swept_field(ball, skin, 2 * kMm, 4 * kMm, sampling);
  const DistanceField thin = swept_field(ball, skin, -2 * kMm, 4 * kMm, sampling);
  const auto at = [](double z) {
    return Vec3(0, 0, z * kMm);
  };
  constexpr double kNear = 0.15 * kMm;
  EXPECT_NEAR(thick.value(at(-3)), 0, kNear);
  EXPECT_NEAR(thick.value(at(-11)), 0, kNear);
  EXPECT_NEAR(thin.value(at(-7)), 0, kNear);
  EXPECT_NEAR(thin.value(at(-11)), 0, kNear);
  EXPECT_NEAR(thick.value(Vec3(3 * kMm, 0, -7 * kMm)), 0, 2 * kNear);  // as wide as before
  // Not only at the surface: what lines it asks some millimetres inside.
  const DistanceField out = offset_field(skin, 2 * kMm, sampling);
  for (const double z : {2.0, 1.0, 0.3, -0.7, -1.9, -4.0, -7.3})
    EXPECT_NEAR(out.value(at(z)), (z - 2) * kMm, kNear) << z;
}

}  // namespace
}  // namespace artus
