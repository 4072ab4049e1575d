// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/space.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/body/layered_body.h"
#include "artus/detail/anatomy/body/liquid.h"
#include "artus/detail/anatomy/body/space_bytes.h"
#include "artus/detail/anatomy/body/space_toml.h"
#include "artus/detail/core/byte_stream.h"
#include "tests/support/layered_body.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::HasSubstr;

const std::string kSpacesElbow =
    "format = 1\nname = \"elbow\"\nunits = \"mm\"\naxes = \"LPS\"\n"
    "[body]\nfile = \"body.stl\"\ntissue = \"fat\"\n"
    "[[structure]]\nname = \"ulna\"\ntissue = \"bone\"\nfile = \"ulna.stl\"\n"
    "[[structure]]\nname = \"recess\"\ntissue = \"synovial_fluid\"\nfile = \"recess.stl\"\n";

std::string refusal(const std::string& text) {
  const auto joint = parse_joint(kSpacesElbow + text, "j");
  return joint ? "" : joint.error().to_string();
}

TEST(Liquids, TheBundledOnesHaveASourceAndThinWithShear) {
  const auto liquids = read_bundled_liquids();
  ASSERT_TRUE(liquids) << liquids.error().to_string();
  EXPECT_GE(liquids->size(), 10U);
  for (const Liquid& liquid : *liquids) {
    EXPECT_FALSE(liquid.source.empty()) << liquid.name;
    EXPECT_LE(liquid.viscosity.at(1e5), liquid.viscosity.at(1)) << liquid.name;
  }
  const auto acid = find_liquid(*liquids, "hyaluronic");
  ASSERT_TRUE(acid);
  EXPECT_NEAR(acid->viscosity.at(0), 5, 1e-12);
  EXPECT_LT(acid->viscosity.at(1e3), 0.1);
  EXPECT_THAT(find_liquid(*liquids, "beer").error().message, HasSubstr("lidocaine"));
}

TEST(Liquids, AFileIsRefusedWithWhatIsWrong) {
  const auto refused = parse_liquids(
      "format = 1\n[liquid.x]\nviscosity_mpa_s = 1\nviscosity_infinite_mpa_s = 0.5\n"
      "density_kg_m3 = 1000\ntissue = \"fluid\"\nsource = \"assumed\"\ncolour = 3\n",
      "f");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("relaxation_s"));
  EXPECT_THAT(refused.error().message, HasSubstr("colour"));
}

TEST(Spaces, EveryTissueOfTheLibraryHasOne) {
  const auto profiles = read_bundled_space_profiles();
  ASSERT_TRUE(profiles) << profiles.error().to_string();
  const auto tissues = read_bundled_tissues();
  ASSERT_TRUE(tissues);
  const auto like = [&](const char* name) {
    const auto at = std::find_if(tissues->begin(), tissues->end(),
                                 [&](const Tissue& t) { return t.name == name; });
    return profile_of(*profiles, *at).space.name;
  };
  EXPECT_EQ(like("bursa"), "bursa");
  EXPECT_EQ(like("muscle"), "muscle");
  EXPECT_EQ(like("synovial_fluid"), "joint");
  EXPECT_EQ(like("ligament"), "capsule");
  EXPECT_EQ(like("artery"), "artery");
  for (const SpaceProfile& p : *profiles) EXPECT_FALSE(p.source.empty()) << p.space.name;
}

TEST(Spaces, AJointsOwnStandOnAProfileAndOverrideIt) {
  const auto joint = parse_joint(kSpacesElbow +
                                     "[[space]]\nname = \"cavity\"\nregions = [\"recess\"]\n"
                                     "like = \"capsulitis_man\"\nrupture_ml = 30\n",
                                 "j");
  ASSERT_TRUE(joint) << joint.error().to_string();
  ASSERT_EQ(joint->spaces.size(), 1U);
  EXPECT_NEAR(joint->spaces[0].law.rupture, 30e-6, 1e-15);
  EXPECT_NEAR(joint->spaces[0].law.stiffness, 2.66644e9, 1);
}

TEST(Spaces, AreRefusedWithWhatIsWrongAndWhatThereIs) {
  const std::string head = "[[space]]\nname = \"s\"\nlike = \"joint\"\n";
  EXPECT_THAT(refusal(head + "regions = [\"reces\"]\n"), HasSubstr("did you mean 'recess'"));
  EXPECT_THAT(refusal("[[space]]\nname = \"s\"\nlike = \"joynt\"\nregions = [\"recess\"]\n"),
              HasSubstr("did you mean 'joint'"));
  EXPECT_THAT(refusal(head + "regions = [\"recess\"]\nleaks_to = \"nowhere\"\n"),
              HasSubstr("which is no space"));
  EXPECT_THAT(refusal(head + "regions = [\"recess\"]\nyield_ml = 50\n"), HasSubstr("rupture_ml"));
  EXPECT_THAT(refusal(head + "regions = [\"recess\"]\n" + head + "regions = [\"recess\"]\n"),
              HasSubstr("in a space already"));
  EXPECT_THAT(refusal("[[space]]\nname = \"s\"\nregions = [\"recess\"]\n"), HasSubstr("law"));
  EXPECT_THAT(refusal(head + "regions = [\"recess\"]\nstiffness_kpa_ml = nan\n"),
              HasSubstr("stiffness_kpa_ml"));
}

class CompiledSpaces : public test::TemporaryFolder {};

TEST_F(CompiledSpaces, AreKeptByACompiledJointAndOneWithoutHasItsOldBytes) {
  const std::vector<FlatLayer> layers{{"muscle", 0.01}, {"bursa", 0.002}};
  CompiledJoint joint = test::make_layered_block(layers, 0.1, 0.1);
  const auto file = in("a.artus");
  ASSERT_TRUE(write_compiled_joint(joint, file));
  const auto plain = std::filesystem::file_size(file);
  Space space;
  space.name = "bursa_space";
  space.regions = {"bursa"};
  space.law.kind = SpaceKind::cavity;
  space.law.stiffness = 2e9;
  joint.spaces = {space};
  ASSERT_TRUE(write_compiled_joint(joint, file));
  EXPECT_GT(std::filesystem::file_size(file), plain);
  const auto back = read_compiled_joint(file);
  ASSERT_TRUE(back) << back.error().to_string();
  ASSERT_EQ(back->spaces.size(), 1U);
  EXPECT_EQ(back->spaces[0].regions, space.regions);
  EXPECT_EQ(back->spaces[0].law.stiffness, 2e9);
  const auto all = make_joint_spaces(*back);
  ASSERT_TRUE(all) << all.error().to_string();
  EXPECT_EQ(all->spaces[all->of_region[region_named(*back, "bursa")]].name, "bursa_space");
  EXPECT_EQ(all->spaces[all->of_region[region_named(*back, "muscle")]].like, "muscle");
  EXPECT_EQ(all->spaces[all->of_region[kOutside]].like, kOutsideSpace);
}

TEST(Spaces, BytesThatAreNoneAreRefused) {
  ByteWriter out;
  Space space;
  space.name = "s";
  put_spaces(out, {space});
  std::string bytes = out.bytes();
  bytes.pop_back();
  ByteReader in(bytes);
  static_cast<void>(get_spaces(in));
  EXPECT_FALSE(in.ok());
  Problems problems;
  const auto table = parse_toml("", "empty");
  TomlTable none(*table, "joint", problems);
  EXPECT_TRUE(read_spaces(none, {})->empty());
}

}  // namespace
}  // namespace artus
