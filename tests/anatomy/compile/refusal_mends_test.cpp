// SPDX-License-Identifier: AGPL-3.0-or-later
// What a refusal says to do is done, word for word, and then the joint compiles.
#include <functional>

#include <gtest/gtest.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "tests/anatomy/compile/joint_folder.h"

namespace artus {
namespace {

using test::JointFolder;
using test::kMm;

/// A surface that nobody can close by itself.
struct Refused {
  const char* name;
  std::function<SurfaceMesh()> make;
};

SurfaceMesh make_sheet() {
  SurfaceMesh sheet;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      sheet.vertices.emplace_back((4.0 * x - 6) * kMm, (4.0 * y - 6) * kMm, 2 * kMm);
  for (std::uint32_t y = 0; y < 3; ++y)
    for (std::uint32_t x = 0; x < 3; ++x) {
      const std::uint32_t a = 4 * y + x;
      sheet.triangles.push_back({a, a + 1, a + 5});
      sheet.triangles.push_back({a, a + 5, a + 4});
    }
  return sheet;
}

SurfaceMesh make_open_box() {
  SurfaceMesh box = make_cube(Vec3::Zero(), 8 * kMm);
  box.triangles.erase(box.triangles.begin() + 2, box.triangles.begin() + 6);  // two sides of six
  return box;
}

SurfaceMesh make_two_sheets() {
  SurfaceMesh two = make_sheet();
  SurfaceMesh other = make_sheet();
  for (Vec3& p : other.vertices) p.z() += 5 * kMm;
  append_mesh(two, other);
  return two;
}

SurfaceMesh make_ball_in_metres() {  // said to be millimetres
  SurfaceMesh ball = make_sphere(Vec3::Zero(), 8 * kMm);
  for (Vec3& p : ball.vertices) p *= kMm;
  return ball;
}

class Mend : public testing::TestWithParam<Refused> {
 protected:
  Mend() : folder_(std::string("mend-") + GetParam().name) {
    folder_.add_sphere("body", Vec3(0, 0, 0), 20);
    EXPECT_TRUE(write_surface(GetParam().make(), folder_.path() / "part.ply", kMm));
  }
  Result<CompileOutcome> compile(const std::string& lines, bool skip_refused = false) {
    folder_.write_toml(
        "[[structure]]\nname = \"part\"\ntissue = \"muscle\"\nfile = \"part.ply\"\n" + lines);
    const auto file = read_joint(folder_.path());
    ARTUS_TRY(file);
    CompileOptions options;
    options.skip_refused = skip_refused;
    return compile_joint(*file, options);
  }
  JointFolder folder_;
};

TEST_P(Mend, EachThatTheRefusalNamesWorks) {
  const auto refused = compile("");
  ASSERT_FALSE(refused) << "nothing to mend";
  const std::string message = refused.error().to_string();
  std::size_t n = 0;
  for (const char* line : {"thicken = 1.0", "repair = \"wrap\"", "units = \"m\""}) {
    if (message.find(line) == std::string::npos) continue;
    ++n;
    const auto mended = compile(line);
    ASSERT_TRUE(mended) << line << ": " << mended.error().to_string() << "\nafter: " << message;
    EXPECT_GT(mended->report.structures[1].resolved_volume, 0) << line;
    EXPECT_LT(std::abs(mended->report.structures[1].volume_error()), 0.1) << line;
  }
  if (message.find("--skip-refused") != std::string::npos) {
    ++n;
    const auto without = compile("", true);
    ASSERT_TRUE(without) << without.error().to_string();
    EXPECT_EQ(without->report.structures[1].resolved_volume, 0);
    EXPECT_FALSE(without->report.structures[1].refused.empty());
  }
  EXPECT_GT(n, 0U) << "no way out is named: " << message;
}
INSTANTIATE_TEST_SUITE_P(Surfaces, Mend,
                         testing::Values(Refused{"sheet", make_sheet},
                                         Refused{"two_sheets", make_two_sheets},
                                         Refused{"open_box", make_open_box},
                                         Refused{"unit", make_ball_in_metres}),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

}  // namespace
}  // namespace artus
