// SPDX-License-Identifier: AGPL-3.0-or-later
// Tissues as bytes and as tables; compiled files.
#include "artus/detail/anatomy/body/tissue.h"

#include <gmock/gmock.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/joint_places.h"
#include "artus/detail/anatomy/body/region.h"
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

class CompiledFiles : public test::TemporaryFolder {};

TEST_F(CompiledFiles, ComeBackWholeAndEveryFlippedByteIsRefused) {
  const std::array<test::FlatLayer, 2> layers{{{"skin", 2e-3}, {"bone", 5e-3}}};
  CompiledJoint joint = test::make_layered_block(layers, 0.1, 0.05);
  joint.landmarks.push_back({"here", Vec3(1, 2, 3)});
  joint.injections.push_back({"first", Vec3(0, 0, 1), Vec3(0, 0, 2), 17});
  joint.regions.back().fibre_axis = Vec3::UnitY();
  joint.regions.back().fibre_course = FibreCourse::layer;
  const std::string file = in("joint.artus");
  ASSERT_TRUE(write_compiled_joint(joint, file));
  const auto back = read_compiled_joint(file);
  ASSERT_TRUE(back) << back.error().to_string();
  EXPECT_EQ(back->mesh.vertices, joint.mesh.vertices);
  EXPECT_EQ(back->regions.back().name, "bone");
  EXPECT_EQ(back->landmarks[0].position, Vec3(1, 2, 3));
  ASSERT_EQ(back->injections.size(), joint.injections.size());
  EXPECT_EQ(back->injections.back().target, Vec3(0, 0, 2));
  EXPECT_EQ(back->injections.back().line, 0) << "a line of a file that is not there";
  EXPECT_EQ(back->regions.back().fibre_axis, Vec3::UnitY());
  EXPECT_EQ(back->regions.back().fibre_course, FibreCourse::layer);
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
