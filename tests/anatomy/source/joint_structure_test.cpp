// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_structure.h"

#include <gmock/gmock.h>

namespace artus {
namespace {

using testing::HasSubstr;

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

TEST(ReadPartitions, AreDeclaredOnceAndNamedByStructuresWithFiles) {
  const auto told = [](const std::string& more) {
    const auto file = parse_joint(
        "format = 1\nname = 'a'\nunits = 'mm'\naxes = 'LPS'\n[body]\nfile = 'b.ply'\n"
        "tissue = 'fat'\ncuts = 'c.ply'\n[partition.labels]\nfilm = 0.2\n"
        "[[structure]]\nname = 'femur'\ntissue = 'bone'\n" +
            more,
        "j");
    return file ? "partition " + file->structures[0].partition +
                      (file->partitions.at(0).film == 0.2e-3 ? " of 0.2 mm" : "") + ", cuts " +
                      std::get<SurfaceFile>(file->body.shape).cuts.string()
                : file.error().message;
  };
  EXPECT_EQ(told("file = 'f.ply'\npartition = 'labels'\n"),
            "partition labels of 0.2 mm, cuts c.ply");
  EXPECT_THAT(told("file = 'f.ply'\npartition = 'label'\n"), HasSubstr("did you mean 'labels'"));
  EXPECT_THAT(told("shell = { thickness = 1 }\npartition = 'labels'\n"),
              HasSubstr("structures with a file"));
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

}  // namespace
}  // namespace artus
