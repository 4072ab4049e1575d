// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/space.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "artus/anatomy/compiled_joint.h"
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

TEST(Spaces, ALawThatIsNewNamesItsKindAndAnotherKeepsWhatIsNotSaid) {
  const auto profiles = read_bundled_space_profiles().value();
  ASSERT_NE(find_profile(profiles, "joint"), nullptr);
  EXPECT_EQ(find_profile(profiles, "joynt"), nullptr);
  const SpaceLaw joint = find_profile(profiles, "joint")->space.law;
  const auto table = parse_toml("stop_kpa = 44", "t").value();
  Problems none;
  SpaceLaw law = joint;
  TomlTable on_top(table, "space", none);
  read_space_law(on_top, false, law);
  EXPECT_TRUE(none.empty());
  EXPECT_DOUBLE_EQ(law.stop, 44e3);
  EXPECT_EQ(law.kind, joint.kind);
  EXPECT_EQ(law.stiffness, joint.stiffness);
  Problems problems;
  TomlTable as_new(table, "space", problems);
  read_space_law(as_new, true, law);
  EXPECT_THAT(problems.refusal(ErrorCode::invalid, "t").value().message,
              HasSubstr("'law' is missing"));
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
}

}  // namespace
}  // namespace artus
