// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle_feel.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/layered_body.h"

namespace artus {
namespace {

// A library of one tissue with these lines among its haptics.
Result<std::vector<Tissue>> library(const std::string& haptic_lines) {
  return parse_tissues(R"(format = 1
[tissue.muscle.acoustic]
speed_of_sound_m_s = 1580
density_kg_m3 = 1060
attenuation_db_cm_mhz = 0.6
backscatter = 1.0
source = "test"
[tissue.muscle.mechanical]
youngs_modulus_pa = 10000
source = "test"
[tissue.muscle.haptic]
cutting_force_n = 2.0
source = "test"
)" + haptic_lines,
                       "test");
}

CompiledJoint joint_with(const std::string& haptic_lines) {
  const std::vector<test::FlatLayer> layers{{"skin", 0.003}, {"muscle", 0.02}};
  CompiledJoint joint = test::make_layered_block(layers, 0.1, 0.1);
  const auto read = library(haptic_lines);
  if (!read) ADD_FAILURE() << read.error().to_string();
  for (Tissue& tissue : joint.tissues)
    if (tissue.name == "muscle") tissue = read->front();
  return joint;
}

LayerHaptics muscle(const CompiledJoint& joint, const NeedleFeel& feel) {
  return make_layer_table(joint, feel)[test::region_named(joint, "muscle")];
}

TEST(LayerTable, TakesTheLawThatTheTissueLibraryNames) {
  for (const CuttingLaw law :
       {CuttingLaw::tracking_wall, CuttingLaw::direct, CuttingLaw::spring, CuttingLaw::voigt}) {
    const auto joint = joint_with("cutting_law = \"" + std::string(to_string(law)) + "\"\n");
    EXPECT_EQ(muscle(joint, {}).cutting, law);
  }
  for (const PrepunctureLaw law : {PrepunctureLaw::membrane, PrepunctureLaw::simone_okamura,
                                   PrepunctureLaw::barbe, PrepunctureLaw::god_object}) {
    const auto joint = joint_with("prepuncture_law = \"" + std::string(to_string(law)) + "\"\n");
    EXPECT_EQ(muscle(joint, {}).prepuncture, law);
  }
  EXPECT_EQ(muscle(joint_with(""), {}).cutting, CuttingLaw::tracking_wall);
}

TEST(LayerTable, TheRunsWordGoesBeforeTheLibrarysAndTheTissuesBeforeTheRuns) {
  const auto joint = joint_with("cutting_law = \"voigt\"\n");
  NeedleFeel feel;
  feel.cutting.all = CuttingLaw::direct;
  EXPECT_EQ(muscle(joint, feel).cutting, CuttingLaw::direct);
  feel.cutting.of_tissue["skin"] = CuttingLaw::tracking_wall;
  EXPECT_EQ(muscle(joint, feel).cutting, CuttingLaw::direct);
  feel.cutting.of_tissue["muscle"] = CuttingLaw::spring;
  EXPECT_EQ(muscle(joint, feel).cutting, CuttingLaw::spring);
}

TEST(LayerTable, AnUnknownLawIsRefusedWithTheNamesThereAre) {
  const auto refused = library("cutting_law = \"butter\"\n");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("tracking_wall, direct, spring, voigt"), std::string::npos)
      << refused.error().to_string();
}

TEST(LayerTable, ThePatientScalesTheTissue) {
  const auto joint = joint_with("");
  NeedleFeel feel;
  feel.patient.cutting = 1.5;
  EXPECT_DOUBLE_EQ(muscle(joint, feel).tissue.cutting_force, 3.0);
}

TEST(LayerTable, ARegionThatIsNotThereFeelsLikeNothing) {
  const LayerTable table = make_layer_table(joint_with(""));
  EXPECT_EQ(table[999].tissue.cutting_force, 0);
  EXPECT_EQ(table[kOutside].tissue.cutting_force, 0);
}

TEST(NeedleFeel, WhatIsNotSetChangesNothing) {
  const NeedleFeel feel;
  EXPECT_EQ(changed(feel), 0U);
  NeedleParams params;
  params.contact.needle_length = 0.05;
  params.clamping = ClampingLaw::plasticity;
  apply(feel, params);
  EXPECT_EQ(params.contact.needle_length, 0.05);
  EXPECT_EQ(params.clamping, ClampingLaw::plasticity);
  EXPECT_FALSE(params.use_workspace);
}

TEST(NeedleFeel, EachKindIsNoticedAndRefusedByItsName) {
  NeedleFeel feel;
  feel.cutting.of_tissue["muscle"] = CuttingLaw::voigt;
  feel.prepuncture.all = PrepunctureLaw::barbe;
  feel.tap = HardLaw::impulse;
  feel.clamping = ClampingLaw::plasticity;
  feel.friction = LugreParams{};
  feel.patient.puncture = 2;
  feel.workspace = HemisphereParams{};
  feel.needle_length = 0.05;
  feel.passivity_control = true;
  EXPECT_EQ(changed(feel), FeelKind::kAll);
  FeelScope scope{"the block", {"muscle"}, FeelKind::kAll, "is stubborn"};
  EXPECT_TRUE(check(feel, scope));
  for (std::uint32_t kind = 1; kind < FeelKind::kAll; kind <<= 1U) {
    scope.takes = FeelKind::kAll & ~kind;
    const auto refused = check(feel, scope);
    ASSERT_FALSE(refused) << kind;
    EXPECT_EQ(refused.error().where, feel_kind_name(kind));
    EXPECT_NE(refused.error().message.find("is stubborn"), std::string::npos);
  }
  const auto elsewhere = check(feel, {"the block", {"bone"}, FeelKind::kAll, ""});
  ASSERT_FALSE(elsewhere);
  EXPECT_EQ(elsewhere.error().code, ErrorCode::not_found);
}

TEST(NeedleFeel, ValuesThatNoBodyHasAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double wrong : {-1.0, 11.0, kNan}) {
    NeedleFeel feel;
    feel.patient.friction = wrong;
    EXPECT_FALSE(validate(feel)) << wrong;
  }
  for (const double wrong : {0.0, -0.05, 1.0, kNan}) {
    NeedleFeel feel;
    feel.needle_length = wrong;
    EXPECT_FALSE(validate(feel)) << wrong;
  }
  NeedleFeel feel;
  feel.friction = LugreParams{};
  feel.friction->mu_s = kNan;
  EXPECT_FALSE(validate(feel));
  feel.friction.reset();
  feel.workspace = HemisphereParams{};
  feel.workspace->radius = 0;
  EXPECT_FALSE(validate(feel));
}

}  // namespace
}  // namespace artus
