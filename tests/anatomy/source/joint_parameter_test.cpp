// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_parameter.h"

#include <gtest/gtest.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/source/joint_parameter_toml.h"
#include "artus/detail/anatomy/source/joint_variant.h"
#include "artus/detail/anatomy/source/joint_variant_toml.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

constexpr const char* kJoint = R"(format = 1
name = "arm"
units = "mm"
axes = "LPS"
[variant.tear]
title = "a tear"
[parameter.fat]
title = "fat"
unit = "mm"
modelled = 5.0
least = 1.0
most = 20.0
acts = [{ key = "body.grow", per = 1.0 }, { key = "structure.skin.shell.thickness", per = 0.1 },
        { key = "tissue.fat.acoustic.attenuation_db_cm_mhz", per = 0.02, base = 0.6 }]
[parameter.tear]
title = "tear"
modelled = 0
least = 0
most = 1
variant = "tear"
[body]
file = "body.ply"
tissue = "fat"
filler = "filler"
[[structure]]
name = "skin"
tissue = "skin"
shell = { thickness = 2.0 }
[[structure]]
name = "hole"
variant = "tear"
tissue = "synovial_fluid"
file = "hole.ply"
)";

class Parameters : public test::TemporaryFolder {
 protected:
  [[nodiscard]] Result<JointFile> read(const std::string& patient,
                                       const std::string& text = kJoint) const {
    return parse_joint(text, with_patient(folder_ / "arm", patient));
  }
  void SetUp() override {
    test::TemporaryFolder::SetUp();
    std::filesystem::create_directories(folder_ / "arm");
  }
};

double attenuation_of_fat(const JointFile& joint) {
  for (const Tissue& t : joint.tissues)
    if (t.name == "fat") return t.acoustic.attenuation;
  return 0;
}

TEST_F(Parameters, AValueMovesEachNumberByItsSlopeFromWhatWasModelled) {
  const auto modelled = read("");
  const auto thick = read("fat=15");
  ASSERT_TRUE(modelled) << modelled.error().to_string();
  ASSERT_TRUE(thick) << thick.error().to_string();
  EXPECT_EQ(std::get<SurfaceFile>(modelled->body.shape).grow, 0);
  EXPECT_NEAR(std::get<SurfaceFile>(thick->body.shape).grow, 10e-3, 1e-12);
  EXPECT_NEAR(std::get<ShellConstruct>(thick->structures[0].shape).thickness, 3e-3, 1e-12);
  EXPECT_NEAR(attenuation_of_fat(*thick) / attenuation_of_fat(*modelled), 0.8 / 0.6, 1e-9);
  EXPECT_EQ(thick->name, "arm@fat=15");
  EXPECT_EQ(modelled->name, "arm");
  ASSERT_EQ(thick->parameters.size(), 2U);
}

TEST_F(Parameters, ARegionThatAVariantBringsGrowsAsTheJointsDoes) {
  std::string text = kJoint;
  const std::string acts = "acts = [";
  text.insert(text.find(acts) + acts.size(),
              "{ key = \"region_of_interest.radius\", per = 1.0 }, ");
  const std::string title = "title = \"a tear\"\n";
  text.insert(text.find(title) + title.size(),
              "region_of_interest = { centre = [0.0, 10.0, 0.0], radius = 20.0 }\n");
  text.insert(text.find("[variant.tear]"),
              "[region_of_interest]\ncentre = [0.0, 0.0, 0.0]\nradius = 40.0\n");
  const auto whole = read("fat=15", text);
  ASSERT_TRUE(whole) << whole.error().to_string();
  EXPECT_DOUBLE_EQ(whole->region_of_interest->radius, 50e-3);
  const auto torn = read("fat=15,tear=1", text);
  ASSERT_TRUE(torn) << torn.error().to_string();
  EXPECT_DOUBLE_EQ(torn->region_of_interest->radius, 30e-3);
}

TEST_F(Parameters, TheModelledValueChangesNothingOfTheShape) {
  const std::string modelled = read("").value().shape;
  EXPECT_EQ(modelled.find("parameter"), std::string::npos);
  EXPECT_NE(read("fat=15").value().shape, modelled);
  EXPECT_EQ(read("fat=15").value().shape, read("fat=15").value().shape);
}

TEST_F(Parameters, AYesSwitchesItsVariantOn) {
  EXPECT_EQ(read("tear=0")->structures.size(), 1U);
  const auto torn = read("tear=1");
  ASSERT_TRUE(torn) << torn.error().to_string();
  EXPECT_EQ(torn->structures.size(), 2U);
  EXPECT_EQ(torn->name, "arm@tear=1");
}

TEST_F(Parameters, APlaceThatIsNotThereIsToldWithItsParameter) {
  std::string text = kJoint;
  text.replace(text.find("body.grow"), 9, "structure.musc.grow");
  const auto joint = read("fat=6", text);
  ASSERT_FALSE(joint);
  EXPECT_NE(joint.error().to_string().find("structure.musc.grow"), std::string::npos)
      << joint.error().to_string();
  std::string no_base = kJoint;
  no_base.replace(no_base.find(", base = 0.6"), 12, "");
  EXPECT_FALSE(read("fat=6", no_base));
  EXPECT_FALSE(read("bone=6"));
}

TEST_F(Parameters, AParameterThatDoesNothingOrStandsOutOfItsRangeIsAProblem) {
  const auto joint = toml::parse(R"([parameter.fat]
title = "fat"
modelled = 0.5
least = 1.0
most = 20.0
)");
  Problems problems;
  EXPECT_EQ(read_parameters(joint, problems).size(), 1U);
  const std::string told = problems.refusal(ErrorCode::invalid, "here").value().to_string();
  EXPECT_NE(told.find("does nothing"), std::string::npos) << told;
  EXPECT_NE(told.find("between 'least' and 'most'"), std::string::npos) << told;
}

TEST_F(Parameters, AVariantThatIsChosenHasItsUsualValueUnlessOneIsSaid) {
  const auto skin_of = [](const std::vector<PatientValue>& patient,
                          const std::vector<std::string>& variants) {
    auto joint = toml::parse(R"([parameter.swelling]
title = "swelling"
modelled = 1.0
least = 1.0
most = 6.0
usual = 3.0
variant = "swollen"
acts = [{ key = "body.grow", per = 0.5 }]
[body]
file = "body.ply"
)");
    Problems problems;
    static_cast<void>(apply_patient(joint, patient, variants, problems));
    EXPECT_TRUE(problems.empty());
    return joint["body"]["grow"].value_or(0.0);
  };
  EXPECT_EQ(skin_of({}, {}), 0);
  EXPECT_EQ(skin_of({}, {"torn"}), 0);
  EXPECT_EQ(skin_of({}, {"swollen"}), 1);
  EXPECT_EQ(skin_of({{"swelling", 5}}, {"swollen"}), 2);
}

TEST_F(Parameters, AUsualValueIsOfAVariantAndWithinWhatTheModelCanTake) {
  const auto joint = toml::parse(R"([parameter.fat]
title = "fat"
modelled = 1.5
least = 1.0
most = 20.0
usual = 30.0
acts = [{ key = "body.grow", per = 1.0 }]
)");
  Problems problems;
  EXPECT_EQ(read_parameters(joint, problems).size(), 1U);
  const std::string told = problems.refusal(ErrorCode::invalid, "here").value().to_string();
  EXPECT_NE(told.find("'usual' must lie"), std::string::npos) << told;
  EXPECT_NE(told.find("needs 'variant'"), std::string::npos) << told;
}

TEST_F(Parameters, OfNobodyTheTableOnlyForgetsItsParameters) {
  auto joint = toml::parse(kJoint);
  Problems problems;
  EXPECT_EQ(apply_patient(joint, {}, {"tear"}, problems), std::vector<std::string>{"tear"});
  EXPECT_TRUE(problems.empty());
  EXPECT_FALSE(joint.contains("parameter"));
  EXPECT_FALSE(joint.contains("tissue"));
  const auto variants = choose_variants(joint, {"tear"}, {}, problems);
  EXPECT_EQ(chosen_names(variants), std::vector<std::string>{"tear"});
}

}  // namespace
}  // namespace artus
