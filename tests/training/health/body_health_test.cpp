// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/body_health.h"

#include <cmath>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/layered_body.h"

namespace artus {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Skin, fat, muscle, a bursa 1 mm thick and bone, whose surfaces can bend: facets of 1 mm.
CompiledJoint layers() {
  const std::vector<FlatLayer> flat{
      {"skin", 2e-3}, {"fat", 4e-3}, {"muscle", 10e-3}, {"bursa", 1e-3}, {"bone", 8e-3}};
  return subdivided(test::make_layered_block(flat, 64e-3, 64e-3), 6);
}

constexpr double kRoof = 16e-3;    // m
constexpr double kFloor = 17e-3;   // m
constexpr double kRadius = 12e-3;  // m, of the lens

/// m by which what lies above the bursa goes up, with 4 mm in the middle.
double lens(const Vec3& p) {
  const double r2 = (p.x() * p.x() + p.y() * p.y()) / (kRadius * kRadius);
  return r2 < 1 ? 4e-3 * (1 - r2) * (1 - r2) : 0;
}
constexpr double kLensVolume = 3.14159265 * kRadius * kRadius * 4e-3 / 3;  // m^3

/// The layers with all above the bursa's floor lifted by `lift`, skin included.
template <class Lift>
CompiledJoint lifted(Lift lift) {
  CompiledJoint joint = layers();
  for (Vec3& p : joint.mesh.vertices)
    if (p.z() < kFloor - 1e-6) p.z() -= lift(p);
  return joint;
}

HealthQuestion question(CompiledJoint after) {
  HealthQuestion q;
  q.before = std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(layers()));
  q.after = std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(after)));
  q.liquid = {{"bursa", "injected"}, {}, kLensVolume, Vec3(0, 0, kRoof)};
  q.X_JP.translation() = Vec3(0, 0, -4.5e-3);
  q.settings.depth = 26e-3;
  q.pictures = false;
  return q;
}

/// Keys of the measures that do not hold.
std::vector<std::string> failures(const HealthQuestion& q) {
  std::vector<std::string> keys;
  for (const HealthMeasure& m : measure_body_health(q).measures)
    if (!m.holds()) keys.push_back(m.key);
  return keys;
}

TEST(BodyHealth, ASmoothLensIsSound) {
  const BodyHealth health = measure_body_health(question(lifted(lens)));
  EXPECT_TRUE(health.sound()) << to_text(health);
  EXPECT_FALSE(health.at("inverted").value) << "it has no tetrahedra";
  EXPECT_FALSE(health.at("strips_percent").value) << "nobody asked for pictures";
  EXPECT_NEAR(*health.at("skin_lift_ml").value, 1e6 * kLensVolume, 0.02e6 * kLensVolume);
}

TEST(BodyHealth, ABlockWithSteepWallsJumps) {
  const auto block = [](const Vec3& p) {
    return std::max(std::abs(p.x()), std::abs(p.y())) < 8.5e-3 ? 6e-3 : 0;
  };
  HealthQuestion q = question(lifted(block));
  q.liquid.volume = 6e-3 * 17e-3 * 17e-3;
  const BodyHealth health = measure_body_health(q);
  EXPECT_GT(*health.at("wall_jump_mm").value, 0.7);
  EXPECT_FALSE(health.sound());
}

TEST(BodyHealth, LiquidThatIsNotThereIsMissed) {
  HealthQuestion q = question(lifted(lens));
  q.liquid.volume = 1.05 * kLensVolume;
  EXPECT_THAT(failures(q), ElementsAre("volume_error_percent"));
}

TEST(BodyHealth, ASkinThatRisesMoreThanTheLiquidExplainsFails) {
  const auto more = [](const Vec3& p) {
    return p.z() < 1e-6 ? 2 * lens(p) : lens(p);
  };
  EXPECT_THAT(failures(question(lifted(more))), ElementsAre("skin_lift_ml"));
}

TEST(BodyHealth, AStructureWhereItWasNotIsAPieceAndANeighbour) {
  CompiledJoint joint = lifted(lens);
  add_ball(joint, {"tendon", Vec3(-12e-3, 0, 10e-3), 3e-3}, test::region_named(joint, "muscle"));
  EXPECT_THAT(failures(question(std::move(joint))), ElementsAre("fragments", "new_neighbours"));
}

TEST(BodyHealth, PicturesOfColumnsDisplacedAgainstEachOtherHaveStrips) {
  const auto columns = [](const Vec3& p) {
    return static_cast<int>(std::floor(p.x() / 1e-3)) % 2 == 0 ? 3.5e-3 : 0;
  };
  HealthQuestion q = question(lifted(columns));
  q.pictures = true;
  q.transducer.n_lines = 128;
  const BodyHealth broken = measure_body_health(q);
  EXPECT_FALSE(broken.at("strips_percent").holds()) << to_text(broken);
  HealthQuestion sound = question(lifted(lens));
  sound.pictures = true;
  sound.transducer.n_lines = 128;
  const BodyHealth whole = measure_body_health(sound);
  EXPECT_TRUE(whole.at("strips_percent").holds()) << to_text(whole);
}

TEST(BodyHealth, WhatTouchesBelowThePictureMayBeLiftedIntoIt) {
  HealthQuestion q = question(lifted(lens));
  q.settings.depth = 20e-3;  // the bursa's roof lies half a millimetre deeper
  EXPECT_THAT(failures(q), IsEmpty());
}

TEST(BodyHealth, ABodyWithoutLiquidIsComparedAllTheSame) {
  HealthQuestion q = question(layers());
  q.liquid = {};
  EXPECT_THAT(failures(q), IsEmpty());
}

TEST(BodyHealth, TellsInWordsAndInJsonWhatFailsWhere) {
  HealthQuestion q = question(lifted(lens));
  q.liquid.volume = 2 * kLensVolume;
  const BodyHealth health = measure_body_health(q);
  EXPECT_THAT(to_text(health), HasSubstr("FAILS  liquid that rays find"));
  const nlohmann::json json = to_json(health);
  EXPECT_FALSE(json["sound"].get<bool>());
  EXPECT_FALSE(json["measures"]["volume_error_percent"]["holds"].get<bool>());
  EXPECT_TRUE(json["measures"]["strips_percent"]["value"].is_null());
  EXPECT_THAT(json["measures"]["volume_error_percent"]["where"].get<std::string>(),
              HasSubstr(" ml"));
}

}  // namespace
}  // namespace artus
