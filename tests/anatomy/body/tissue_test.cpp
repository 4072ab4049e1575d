// SPDX-License-Identifier: AGPL-3.0-or-later
// Tissues as bytes and as tables; the structures of a joint file one by one.
#include "artus/detail/anatomy/body/tissue.h"

#include <gmock/gmock.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/joint_structure.h"
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/body/tissue_bytes.h"
#include "artus/detail/anatomy/body/tissue_toml.h"
#include "artus/detail/core/text_file.h"
#include "tests/support/layered_body.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::HasSubstr;

std::string bytes_of(const std::vector<Tissue>& tissues) {
  ByteWriter out;
  put_tissues(out, tissues);
  return out.bytes();
}

TEST(TissueBytes, EveryValueComesBack) {
  std::vector<Tissue> tissues = *read_bundled_tissues();
  tissues[3].haptic.cutting_law = CuttingLaw::voigt;
  tissues[4].haptic.prepuncture_law = PrepunctureLaw::barbe;
  const std::string bytes = bytes_of(tissues);
  ByteReader in(bytes);
  const std::vector<Tissue> back = get_tissues(in);
  EXPECT_TRUE(in.ok());
  EXPECT_TRUE(in.at_end());
  ASSERT_EQ(back.size(), tissues.size());
  EXPECT_EQ(bytes_of(back), bytes);
  EXPECT_EQ(back[3].haptic.cutting_law, CuttingLaw::voigt);
  EXPECT_EQ(back[4].source, tissues[4].source);
}

TEST(TissueBytes, EveryChangedValueChangesTheBytes) {
  const Tissue before;
  const std::string bytes = bytes_of({before});
  const auto differs = [&bytes](auto change) {
    Tissue tissue;
    change(tissue);
    return bytes_of({tissue}) != bytes;
  };
  EXPECT_TRUE(differs([](Tissue& t) { t.acoustic.attenuation_power *= 1.05; }));
  EXPECT_TRUE(differs([](Tissue& t) { t.mechanical.poisson_ratio *= 1.05; }));
  EXPECT_TRUE(differs([](Tissue& t) { t.haptic.puncture_force = 1; }));
  EXPECT_TRUE(differs([](Tissue& t) { t.haptic.hard = true; }));
  EXPECT_TRUE(differs([](Tissue& t) { t.acoustic.kind = TissueKind::nerve; }));
}

TEST(TissueBytes, CutShortOrOutOfRangeTheyAreRefused) {
  const std::string bytes = bytes_of(test::make_test_tissues());
  for (std::size_t n = 0; n < bytes.size(); n += 7) {
    ByteReader in(std::string_view(bytes).substr(0, n));
    static_cast<void>(get_tissues(in));
    EXPECT_FALSE(in.ok()) << n;
  }
  std::string wrong = bytes_of({Tissue{}});
  wrong[wrong.size() - 5] = 99;  // the prepuncture law, before the count of sources
  ByteReader in(wrong);
  static_cast<void>(get_tissues(in));
  EXPECT_FALSE(in.ok());
}

TEST(MergeTissues, OverridesValueByValueAndAppendsOnlyWhatIsComplete) {
  std::vector<Tissue> tissues = test::make_test_tissues();
  const double density = tissues[1].acoustic.density;
  Problems problems;
  merge_tissues(*parse_toml("[skin.acoustic]\nspeed_of_sound_m_s = 1600\n", "t"), "the joint",
                tissues, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(tissues[1].acoustic.speed_of_sound, 1600);
  EXPECT_EQ(tissues[1].acoustic.density, density);
  EXPECT_EQ(tissues[1].source.at("acoustic"), "the joint");
  merge_tissues(*parse_toml("[ivory.haptic]\ncutting_force_n = 3\n", "t"), "the joint", tissues,
                problems);
  EXPECT_THAT(problems.refusal(ErrorCode::invalid, "t").value().message,
              HasSubstr("[tissue.ivory.acoustic] is missing"));
}

TEST(ReadStructure, TakesOneShapeInMetresAndNamesWhatItLeansOn) {
  Problems problems;
  const auto read = [&problems](const char* text) {
    return read_structure(*parse_toml(text, "t"), 1, 1e-3, problems);
  };
  const Structure cap = read(
      "name = 'c'\ntissue = 'cartilage'\ncap = {on = 'bone', near = ['a', 'b'], within = 6, "
      "thickness = 2}\nfibre_axis = [0, 0, 2]\n");
  EXPECT_TRUE(problems.empty());
  EXPECT_DOUBLE_EQ(std::get<CapConstruct>(cap.shape).within, 6e-3);
  EXPECT_EQ(names_of(cap), (std::vector<std::string>{"a", "b", "bone"}));
  EXPECT_EQ(cap.fibre_axis, Vec3::UnitZ());
  static_cast<void>(read("name = 'c'\ntissue = 't'\nfile = 'a.stl'\nshell = {thickness = 1}\n"));
  EXPECT_THAT(problems.refusal(ErrorCode::invalid, "t").value().message,
              HasSubstr("exactly one of"));
}

TEST(ReadStructure, TellsHowFibresFollowTheirAxis) {
  const auto read = [](const std::string& text, Problems& problems) {
    return read_structure(
        *parse_toml("name = 'm'\ntissue = 'muscle'\nfile = 'm.ply'\n" + text, "t"), 1, 1e-3,
        problems);
  };
  Problems none;
  EXPECT_EQ(read("", none).fibre_course, FibreCourse::ends);
  EXPECT_EQ(read("fibre_axis = [0, 0, 1]\nfibre_course = 'layer'\n", none).fibre_course,
            FibreCourse::layer);
  EXPECT_TRUE(none.empty());
  Problems wrong;
  static_cast<void>(read("fibre_course = 'layer'\n", wrong));
  static_cast<void>(read("fibre_axis = [0, 0, 1]\nfibre_course = 'straight'\n", wrong));
  const std::string said = wrong.refusal(ErrorCode::invalid, "t").value().message;
  EXPECT_THAT(said, HasSubstr("needs fibre_axis = [x, y, z]"));
  EXPECT_THAT(said, HasSubstr("must be \"ends\" or \"layer\", not \"straight\""));
}

TEST(LengthUnit, KnowsThreeAndReportsOthers) {
  Problems problems;
  const toml::table table = *parse_toml("a = 'mm'\nb = 'cm'\nc = 'm'\nd = 'inch'\n", "t");
  TomlTable toml(table, "t", problems);
  EXPECT_EQ(length_unit(toml, "a", 5), 1e-3);
  EXPECT_EQ(length_unit(toml, "b", 5), 1e-2);
  EXPECT_EQ(length_unit(toml, "c", 5), 1);
  EXPECT_EQ(length_unit(toml, "absent", 5), 5);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(length_unit(toml, "d", 5), 5);
  EXPECT_FALSE(problems.empty());
}

class CompiledFiles : public test::TemporaryFolder {};

TEST_F(CompiledFiles, ComeBackWholeAndEveryFlippedByteIsRefused) {
  const std::array<test::FlatLayer, 2> layers{{{"skin", 2e-3}, {"bone", 5e-3}}};
  CompiledJoint joint = test::make_layered_block(layers, 0.1, 0.05);
  joint.landmarks.push_back({"here", Vec3(1, 2, 3)});
  const std::string file = in("joint.artus");
  ASSERT_TRUE(write_compiled_joint(joint, file));
  const auto back = read_compiled_joint(file);
  ASSERT_TRUE(back) << back.error().to_string();
  EXPECT_EQ(back->mesh.vertices, joint.mesh.vertices);
  EXPECT_EQ(back->regions.back().name, "bone");
  EXPECT_EQ(back->landmarks[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(back->tissue_of(kFirstRegion).name, "skin");
  std::string bytes = *read_bytes(file);
  for (std::size_t i = 0; i < bytes.size(); i += bytes.size() / 97) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    ASSERT_TRUE(write_text(file, damaged));
    EXPECT_FALSE(read_compiled_joint(file)) << "byte " << i;
  }
}

}  // namespace
}  // namespace artus
