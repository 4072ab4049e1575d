// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/joint_file.h"

#include <fstream>

#include <gmock/gmock.h>

#include "artus/detail/core/units.h"
#include "tests/anatomy/surfaces/surface_samples.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kHead =
    "format = 1\nname = \"elbow\"\nunits = \"mm\"\naxes = \"LPS\"\n"
    "[body]\nfile = \"body.stl\"\ntissue = \"fat\"\n";
const std::string kBone =
    "[[structure]]\nname = \"ulna\"\ntissue = \"bone\"\nfile = \"ulna.stl\"\n";

/// The first example of a page of docs/: what the documentation shows must be read as it stands.
std::string documented_example(const char* page) {
  std::ifstream in(artus::test::source_dir() / "docs" / page);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  text.erase(0, text.find("```toml") + 8);
  return text.substr(0, text.find("```"));
}

std::string messages_of(const std::string& text) {
  const auto joint = parse_joint(text, "j");
  return joint ? "" : joint.error().to_string();
}

TEST(JointFile, TheSmallestJointHasDefaults) {
  const auto joint = parse_joint(kHead + kBone, "j");
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_EQ(joint->name, "elbow");
  EXPECT_EQ(joint->side, "none");
  EXPECT_EQ(joint->filler_name, "fat");
  EXPECT_DOUBLE_EQ(joint->facet_size, 2e-3);
  EXPECT_DOUBLE_EQ(std::get<SurfaceFile>(joint->structures[0].shape).unit, 1e-3);
  EXPECT_FALSE(joint->region_of_interest);
  EXPECT_FALSE(joint->X_JP_default);
  EXPECT_FALSE(joint->X_JN_default);
  EXPECT_GE(joint->tissues.size(), 18U) << "the bundled library";
}

TEST(JointFile, TheDocumentedExampleParsesButForTheStructuresItLeavesOut) {
  std::string text = documented_example("joint-format.md");
  text.erase(text.find("tissue_library"), text.find("surfaces =") - text.find("tissue_library"));
  for (const char* name : {"scapula", "supraspinatus", "deltoid_acromial"})
    text += std::string("\n[[structure]]\nname = \"") + name +
            "\"\ntissue = \"bone\"\nfile = \"x.ply\"\n";
  const auto joint = parse_joint(text, "j");
  ASSERT_TRUE(joint) << joint.error().to_string();
  ASSERT_EQ(joint->structures.size(), 8U);
  const auto& gap = std::get<GapConstruct>(joint->structures[3].shape);
  EXPECT_EQ(gap.roof.size(), 2U);
  EXPECT_DOUBLE_EQ(gap.radius, 0.048);
  EXPECT_DOUBLE_EQ(gap.edge, 0.002);
  EXPECT_DOUBLE_EQ(gap.inflation, 5e-6);
  EXPECT_DOUBLE_EQ(std::get<EndConstruct>(joint->structures[4].shape).within, 0.025);
  EXPECT_DOUBLE_EQ(std::get<ShellConstruct>(joint->structures[1].shape).thickness, 0.0018);
  EXPECT_DOUBLE_EQ(std::get<CapConstruct>(joint->structures[2].shape).thickness, 0.0015);
  EXPECT_TRUE(joint->X_JP_default->linear().col(2).isApprox(Vec3::UnitX()));
  EXPECT_TRUE(joint->X_JP_default->linear().col(0).isApprox(Vec3::UnitZ()));
  EXPECT_TRUE(joint->X_JN_default->translation().isApprox(Vec3(-0.195, -0.05, 1.34)));
  ASSERT_EQ(joint->injections.size(), 1U);
  ASSERT_EQ(joint->landmarks.size(), 1U);
  for (const auto& t : joint->tissues) {
    if (t.name == "muscle") {
      EXPECT_DOUBLE_EQ(t.haptic.cutting_force, 2.2);
      EXPECT_DOUBLE_EQ(t.acoustic.density, 1058) << "what is not overridden stays";
    }
  }
}

TEST(JointFile, AllProblemsAreInOneMessageWithTheirPlaces) {
  const std::string message = messages_of(
      "format = 1\nname = \"My Elbow\"\nunits = \"inch\"\naxes = \"LPX\"\nsid = \"left\"\n"
      "[body]\nfile = \"b.stl\"\ntissue = \"fatt\"\n"
      "[[structure]]\nname = \"ulna\"\ntissue = \"bonne\"\nfile = \"u.stl\"\nthicken = -1\n"
      "[[structure]]\nname = \"ulna\"\ntissue = \"skin\"\nshell = { thickness = 0 }\n"
      "[[structure]]\nname = \"rim\"\ntissue = \"cartilage\"\n"
      "cap = { on = \"ulma\", near = [], within = 5, thickness = 1 }\n"
      "[[structure]]\nname = \"nothing\"\ntissue = \"bone\"\n");
  for (const char* part :
       {"j/joint.toml: ", "2:8: joint: 'name' may contain only a-z, 0-9 and -",
        "3:9: joint: 'units' must be \"mm\", \"cm\" or \"m\"", "4:8: joint: 'axes' must be",
        "5:1: joint: unknown key 'sid' (did you mean 'side'?)",
        "body: unknown tissue 'fatt' (did you mean 'fat'?)",
        "9:1: structure 'ulna': unknown tissue 'bonne' (did you mean 'bone'?)",
        "13:11: structure 'ulna': 'thicken' must be a number from 0 to", "the name is already used",
        "'thickness' must be greater than 0",
        "names 'ulma', which is not a structure of this file (did you mean 'ulna'?)",
        "'near' must be a list of texts", "needs exactly one of 'file', 'shell'"})
    EXPECT_THAT(message, HasSubstr(part));
}

TEST(JointFile, SyntaxErrorNamesLineAndColumn) {
  EXPECT_THAT(messages_of("format = 1\nname = elbow\n"), HasSubstr("joint.toml:2:"));
}

TEST(JointFile, LeftHandedAxesAreRefused) {
  std::string text = kHead + kBone;
  text.replace(text.find("LPS"), 3, "RPS");
  EXPECT_THAT(messages_of(text), HasSubstr("right-handed"));
  text.replace(text.find("RPS"), 3, "RAS");
  EXPECT_EQ(messages_of(text), "");
}

TEST(JointFile, ARegionIsABallOrABoxNotBoth) {
  EXPECT_EQ(messages_of(kHead + kBone + "[region_of_interest]\ncentre = [0,0,0]\nradius = 5\n"),
            "");
  EXPECT_THAT(messages_of(kHead + kBone +
                          "[region_of_interest]\ncentre = [0,0,0]\nradius = 5\n"
                          "half_extent = [1,1,1]\n"),
              HasSubstr("either 'radius'"));
}

TEST(JointFile, InjectionsHaveNamesOfTheirOwn) {
  const std::string one = "[[injection]]\nname = \"a\"\nentry = [0,0,0]\ntarget = [0,0,9]\n";
  std::string other = one;
  other.replace(other.find("\"a\""), 3, "\"b\"");
  EXPECT_EQ(messages_of(kHead + kBone + one + other), "");
  EXPECT_THAT(messages_of(kHead + kBone + one + one), HasSubstr("'name' is already used"));
}

TEST(JointFile, ATissueOfItsOwnMustBeComplete) {
  EXPECT_THAT(messages_of(kHead + kBone + "[tissue.wax.haptic]\ncutting_force_n = 1\n"),
              HasSubstr("the group [tissue.wax.acoustic] is missing"));
}

TEST(JointFile, ConstructsMustNotRunInACircle) {
  const std::string lining =
      "[[structure]]\nname = \"inner\"\ntissue = \"capsule\"\n"
      "shell = { inside = \"outer\", thickness = 1 }\n"
      "[[structure]]\nname = \"outer\"\ntissue = \"capsule\"\n";
  EXPECT_EQ(messages_of(kHead + kBone + lining + "shell = { inside = \"ulna\", thickness = 1 }\n"),
            "");
  const std::string message =
      messages_of(kHead + kBone + lining + "shell = { inside = \"inner\", thickness = 1 }\n");
  EXPECT_THAT(message, HasSubstr("structure 'inner': is made from structures that are made"));
  EXPECT_THAT(message, HasSubstr("structure 'outer': is made from structures that are made"));
  EXPECT_THAT(message, Not(HasSubstr("'ulna'")));
}

TEST(JointFile, TheEndOfAConstructNeedsItsInsertion) {
  const std::string construct =
      "[[structure]]\nname = \"lining\"\ntissue = \"capsule\"\nshell = { thickness = 1 }\n"
      "[[structure]]\nname = \"end\"\ntissue = \"tendon\"\n"
      "end = { of = \"lining\", toward = \"ulna\", within = 5";
  EXPECT_THAT(messages_of(kHead + kBone + construct + " }\n"), HasSubstr("insertion = [x, y, z]"));
  EXPECT_EQ(messages_of(kHead + kBone + construct + ", insertion = [0, 0, 0] }\n"), "");
}

TEST(JointFile, MissingFilesAreAllNamed) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "elbow";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "joint.toml") << kHead + kBone;
  const auto joint = read_joint(folder);
  ASSERT_FALSE(joint);
  EXPECT_EQ(joint.error().code, ErrorCode::not_found);
  EXPECT_THAT(joint.error().message, HasSubstr("no file 'body.stl'"));
  EXPECT_THAT(joint.error().message, HasSubstr("no file 'ulna.stl'"));
  const auto nowhere = read_joint(folder, "/no/such/folder");
  ASSERT_FALSE(nowhere);
  EXPECT_THAT(nowhere.error().message, HasSubstr("--surfaces DIR or ARTUS_SURFACES_ELBOW"));
  EXPECT_EQ(read_joint("/no/such/joint").error().code, ErrorCode::not_found);
}

TEST(JointFile, TheRealShoulderIsRead) {
  const auto surfaces = real_shoulder_folder();
  if (surfaces.empty()) GTEST_SKIP() << "the real shoulder is not at hand";
  const auto joint = read_joint(artus::test::source_dir() / "meshes/real-shoulder", surfaces);
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_GE(joint->structures.size(), 25U);
}

TEST(TissueLibrary, TheBundledOneIsTheFileOfTheRepository) {
  const auto bundled = read_bundled_tissues();
  const auto file = read_tissues(artus::test::source_dir() / "meshes/tissues.toml");
  ASSERT_TRUE(bundled) << bundled.error().to_string();
  ASSERT_TRUE(file) << file.error().to_string();
  ASSERT_EQ(bundled->size(), file->size());
  for (std::size_t i = 0; i < file->size(); ++i) EXPECT_EQ((*bundled)[i].name, (*file)[i].name);
}

TEST(TissueLibrary, HoldsTheForcesOfThePublishedTest) {
  const auto tissues = read_bundled_tissues();
  ASSERT_TRUE(tissues);
  const auto force = [&](const std::string& name) {
    for (const auto& t : *tissues)
      if (t.name == name) return t.haptic.cutting_force;
    return -1.0;
  };
  EXPECT_EQ(force("skin"), 1.0);  // [Alamilla2020] table 4.2
  EXPECT_EQ(force("muscle"), 2.0);
  EXPECT_EQ(force("bursa"), 1.5);
  EXPECT_EQ(force("tendon"), 2.5);
  EXPECT_EQ(force("cartilage"), 3.0);
  EXPECT_EQ(force("bone"), 4.0);
}

TEST(TissueLibrary, BrightnessFollowsTheDisplayOrder) {
  const auto tissues = read_bundled_tissues();
  ASSERT_TRUE(tissues);
  double last = -1;
  for (const char* name : {"synovial_fluid", "cartilage", "fat", "muscle", "nerve", "tendon"}) {
    for (const auto& t : *tissues) {
      if (t.name != name) continue;
      EXPECT_GT(t.acoustic.backscatter, last) << name;
      last = t.acoustic.backscatter;
    }
  }
}

TEST(TissueLibrary, EveryGroupNamesItsSourceOrSaysAssumed) {
  const auto tissues = read_bundled_tissues();
  ASSERT_TRUE(tissues);
  for (const auto& t : *tissues) {
    ASSERT_EQ(t.source.size(), 3U) << t.name;
    for (const auto& [group, source] : t.source)
      EXPECT_TRUE(source.find('[') != std::string::npos ||
                  source.find("assumed:") != std::string::npos)
          << t.name << " " << group;
  }
}

TEST(TissueLibrary, AttenuationBecomesNeperPerMetre) {
  const auto tissues = parse_tissues(documented_example("tissues.md"), "t");
  ASSERT_TRUE(tissues) << tissues.error().to_string();
  EXPECT_NEAR((*tissues)[0].acoustic.attenuation * kDecibelPerNeper, 75, 1e-9);  // 0.75 dB/cm
}

TEST(TissueLibrary, ValuesOutOfTheirRangeAreRefusedWithTheirPlace) {
  std::string text = documented_example("tissues.md");
  text.replace(text.find("0.49"), 4, "0.51");
  const auto tissues = parse_tissues(text, "t.toml");
  ASSERT_FALSE(tissues);
  EXPECT_EQ(tissues.error().code, ErrorCode::invalid);
  EXPECT_THAT(tissues.error().to_string(),
              HasSubstr("tissue 'muscle' mechanical: 'poisson_ratio' must be a number from 0"));
}

}  // namespace
}  // namespace artus
