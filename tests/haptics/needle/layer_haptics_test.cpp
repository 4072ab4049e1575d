// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle/layer_haptics.h"

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

LayerHaptics muscle(const CompiledJoint& joint, const LawSelection& laws,
                    const PatientProfile& patient = {}) {
  return LayerTable(joint, laws, patient)[test::region_named(joint, "muscle")];
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
  LawSelection laws;
  laws.cutting = CuttingLaw::direct;
  EXPECT_EQ(muscle(joint, laws).cutting, CuttingLaw::direct);
  laws.cutting_of_tissue["skin"] = CuttingLaw::tracking_wall;
  EXPECT_EQ(muscle(joint, laws).cutting, CuttingLaw::direct);
  laws.cutting_of_tissue["muscle"] = CuttingLaw::spring;
  EXPECT_EQ(muscle(joint, laws).cutting, CuttingLaw::spring);
}

TEST(LayerTable, AnUnknownLawIsRefusedWithTheNamesThereAre) {
  const auto refused = library("cutting_law = \"butter\"\n");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("tracking_wall, direct, spring, voigt"), std::string::npos)
      << refused.error().to_string();
}

TEST(LayerTable, ThePatientScalesTheTissue) {
  const auto joint = joint_with("");
  PatientProfile patient;
  patient.cutting = 1.5;
  EXPECT_DOUBLE_EQ(muscle(joint, {}, patient).tissue.cutting_force, 3.0);
}

TEST(LayerTable, ARegionThatIsNotThereFeelsLikeNothing) {
  const LayerTable table(joint_with(""), {}, {});
  EXPECT_EQ(table[999].tissue.cutting_force, 0);
  EXPECT_EQ(table[kOutside].tissue.cutting_force, 0);
}

}  // namespace
}  // namespace artus
