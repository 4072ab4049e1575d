// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_variant.h"

#include <sstream>

#include <gmock/gmock.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/source/joint_variant_toml.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kElbow = R"(format = 1
name = "elbow"
units = "mm"
axes = "LPS"
[region_of_interest]
centre = [0.0, 0.0, 0.0]
radius = 40.0
[variant.effusion]
title = "fluid in the joint"
[variant.loose_body]
title = "a loose body in the posterior recess"
region_of_interest = { centre = [0.0, 10.0, 0.0], radius = 20.0 }
[[variant.loose_body.injection]]
name = "recess"
entry = [0.0, 20.0, 0.0]
target = [0.0, 10.0, 0.0]
[body]
file = "body.stl"
tissue = "fat"
[[structure]]
name = "ulna"
tissue = "bone"
file = "ulna.stl"
[[structure]]
name = "recess"
variant = ["effusion", "loose_body"]
tissue = "synovial_fluid"
file = "recess.stl"
[[structure]]
name = "body_in_joint"
variant = "loose_body"
tissue = "cartilage"
file = "loose.stl"
[[injection]]
name = "front"
entry = [0.0, -20.0, 0.0]
target = [0.0, -10.0, 0.0]
[[space]]
name = "joint"
variant = "effusion"
regions = ["recess"]
like = "joint"
)";

std::vector<std::string> names(const std::vector<Structure>& structures) {
  std::vector<std::string> out;
  for (const Structure& s : structures) out.push_back(s.name);
  return out;
}

class VariantFolder : public test::TemporaryFolder {};

TEST(JointVariant, WhatBelongsToAVariantIsThereOnlyWithIt) {
  const auto plain = parse_joint(kElbow, "elbow");
  ASSERT_TRUE(plain) << plain.error().to_string();
  EXPECT_EQ(plain->name, "elbow");
  EXPECT_THAT(names(plain->structures), ElementsAre("ulna"));
  EXPECT_TRUE(plain->spaces.empty());
  const auto wet = parse_joint(kElbow, "elbow+effusion");
  ASSERT_TRUE(wet) << wet.error().to_string();
  EXPECT_EQ(wet->name, "elbow+effusion");
  EXPECT_THAT(names(wet->structures), ElementsAre("ulna", "recess"));
  EXPECT_EQ(wet->spaces.size(), 1U);
  EXPECT_EQ(wet->injections.front().name, "front");
  const auto both = parse_joint(kElbow, "elbow+loose_body+effusion");
  ASSERT_TRUE(both) << both.error().to_string();
  EXPECT_THAT(names(both->structures), ElementsAre("ulna", "recess", "body_in_joint"));
  EXPECT_THAT(chosen_names(both->variants), ElementsAre("effusion", "loose_body"));
}

TEST(JointVariant, WhatIsThereUnlessAnotherIsChosenGivesWayToIt) {
  const std::string second =
      "[[structure]]\nname = \"recess\"\nvariant = \"effusion\"\ntissue = \"bursa\"\n"
      "file = \"wide.stl\"\n[[injection]]";
  std::string text = kElbow;
  text.replace(text.find("[[injection]]"), 13, second);
  EXPECT_FALSE(parse_joint(text, "elbow+effusion")) << "two of a name";
  const std::string condition = "variant = [\"effusion\", \"loose_body\"]\n";
  text.replace(text.find(condition), condition.size(), condition + "unless = \"effusion\"\n");
  const auto wet = parse_joint(text, "elbow+effusion+loose_body");
  ASSERT_TRUE(wet) << wet.error().to_string();
  EXPECT_THAT(names(wet->structures), ElementsAre("ulna", "body_in_joint", "recess"));
  const auto dry = parse_joint(text, "elbow+loose_body");
  ASSERT_TRUE(dry) << dry.error().to_string();
  EXPECT_THAT(names(dry->structures), ElementsAre("ulna", "recess", "body_in_joint"));
}

TEST(JointVariant, NoWordOfThemIsLeft) {
  auto table = parse_toml(kElbow, "elbow");
  ASSERT_TRUE(table);
  Problems problems;
  const auto declared = choose_variants(*table, {"effusion"}, {"effusion"}, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(declared.size(), 2U);
  std::ostringstream left;
  left << *table;
  EXPECT_EQ(left.str().find("variant"), std::string::npos) << left.str();
}

TEST(JointVariant, ItsOwnRegionAndInjectionsStandInThePlaceOfTheJoints) {
  const auto joint = parse_joint(kElbow, "elbow+loose_body");
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_DOUBLE_EQ(joint->region_of_interest->radius, 20e-3);
  ASSERT_EQ(joint->injections.size(), 1U);
  EXPECT_EQ(joint->injections.front().name, "recess");
}

TEST(JointVariant, OneThatThereIsNotListsThoseThereAre) {
  const auto joint = parse_joint(kElbow, "elbow+efusion");
  ASSERT_FALSE(joint);
  EXPECT_THAT(joint.error().message, HasSubstr("did you mean 'effusion'"));
  EXPECT_THAT(joint.error().message, HasSubstr("effusion, loose_body"));
}

TEST(JointVariant, MistakesAreToldWhetherItIsChosenOrNot) {
  const auto refusal = [](std::string from, const std::string& to) {
    std::string text = kElbow;
    text.replace(text.find(from), from.size(), to);
    const auto joint = parse_joint(text, "elbow");
    return joint ? std::string() : joint.error().to_string();
  };
  EXPECT_THAT(refusal("variant = \"loose_body\"", "variant = \"loose\""), HasSubstr("loose"));
  EXPECT_THAT(refusal("variant = \"loose_body\"", "variant = 3"), HasSubstr("name"));
  EXPECT_THAT(refusal("title = \"fluid in the joint\"", "tittle = \"x\""), HasSubstr("tittle"));
  EXPECT_THAT(refusal("[variant.effusion]", "[variant.Effusion]"), HasSubstr("Effusion"));
}

TEST_F(VariantFolder, AVariantShapesTheBodyOnlyWhereItIsChosen) {
  const std::string plain = parse_joint(kElbow, in("elbow")).value().shape;
  const std::string wet = parse_joint(kElbow, in("elbow+effusion")).value().shape;
  EXPECT_NE(plain, wet);
  std::string without = kElbow;
  const auto at = without.find("[[structure]]\nname = \"body_in_joint\"");
  without.erase(at, without.find("[[injection]]\nname = \"front\"") - at);
  EXPECT_EQ(parse_joint(without, in("elbow")).value().shape, plain);
  EXPECT_EQ(parse_joint(without, in("elbow+effusion")).value().shape, wet);
}

TEST(JointVariant, ABundledJointIsReadByItsName) {
  const auto knee = read_joint("knee");
  ASSERT_TRUE(knee) << knee.error().to_string();
  EXPECT_EQ(knee->name, "knee");
}

/// How bright a joint's tissues are, all together: what a variant that changes a tissue changes.
double brightness(const JointFile& joint) {
  double sum = 0;
  for (const Tissue& tissue : joint.tissues) sum += tissue.acoustic.backscatter;
  return sum;
}

TEST(JointVariant, EveryOneOfTheShoulderIsReadAloneAndNamesItsSurfaces) {
  const std::filesystem::path folder = test::source_dir() / "meshes/shoulder";
  const auto plain = read_joint(folder);
  ASSERT_TRUE(plain) << plain.error().to_string();
  ASSERT_GE(plain->variants.size(), 7U);
  for (const JointVariant& variant : plain->variants) {
    const auto joint = read_joint(with_variant(folder, variant.name));
    ASSERT_TRUE(joint) << joint.error().to_string();
    EXPECT_TRUE(joint->structures.size() > plain->structures.size() ||
                brightness(*joint) > brightness(*plain))
        << variant.name;
    EXPECT_FALSE(variant.title.empty());
  }
}

TEST(JointVariant, AnyTwoOfABundledJointAndAnyDrawnPatientCanBeRead) {
  const auto read = [](const std::string& name) {
    auto joint = read_joint(test::source_dir() / "meshes" / name);
    EXPECT_TRUE(joint) << joint.error().to_string();
    return joint ? *joint : JointFile{};
  };
  for (const std::string name :
       {"simple-shoulder", "shoulder", "elbow", "wrist", "hip", "knee", "ankle"}) {
    const JointFile joint = read(name);
    std::vector<std::string> forms{name};
    for (const JointVariant& one : joint.variants) {
      forms.push_back(name + "+" + one.name);
      for (const JointVariant& other : joint.variants)
        if (one.name < other.name) read(name + "+" + one.name + "+" + other.name);
    }
    if (joint.parameters.empty()) continue;
    for (const std::string& form : forms)
      for (int seed = 1; seed <= 20; ++seed) read(form + "@seed=" + std::to_string(seed));
  }
}

}  // namespace
}  // namespace artus
