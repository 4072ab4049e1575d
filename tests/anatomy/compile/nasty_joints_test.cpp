// SPDX-License-Identifier: AGPL-3.0-or-later
// Joints as a careless export or a slip of the pen leaves them: each is refused with a sentence
// that names its mend, or compiled; and what the sentence says is done, and then it compiles.
#include <functional>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/compile/check/joint_check.h"
#include "tests/anatomy/compile/joint_folder.h"

namespace artus {
namespace {

using test::JointFolder;
using test::kMm;
using testing::HasSubstr;

constexpr const char* kPart = R"([[structure]]
name = "part"
tissue = "muscle"
file = "part.off"
)";
constexpr const char* kRegion = "[region_of_interest]\ncentre = [0.0, 0.0, 0.0]\nradius = ";

/// What is wrong, what the refusal says, and what it asks for.
struct Nasty {
  const char* name;
  std::function<std::string()> part;  ///< content of part.off
  std::string toml;
  std::string says;
  std::string mended_toml;  ///< as `toml` where the file is mended
};

/// A ball, each n-th vertex of which is `lost`; 0: none.
std::string ball(std::size_t n_th = 0, const char* lost = "nan") {
  const SurfaceMesh mesh = make_sphere(Vec3(0, 0, 5), 10);
  std::ostringstream out;
  out << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3& p = mesh.vertices[i];
    if (n_th > 0 && i % n_th == 0)
      out << lost << ' ' << lost << ' ' << lost << '\n';
    else
      out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
  for (const Triangle& t : mesh.triangles)
    out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return out.str();
}

std::string good() {
  return ball();
}

class NastyJoint : public testing::TestWithParam<Nasty> {
 protected:
  NastyJoint() : folder_(std::string("nasty-") + GetParam().name) {
    folder_.add_sphere("body", Vec3(0, 0, 0), 30);
    folder_.add_bone();
  }
  Result<CompileOutcome> compile(const std::string& part, const std::string& toml) {
    std::ofstream(folder_.path() / "part.off") << part;
    folder_.write_toml(toml);
    const auto file = read_joint(folder_.path());
    ARTUS_TRY(file);
    CompileOptions options;
    options.check_plans = true;
    return compile_joint(*file, options);
  }
  JointFolder folder_;
};

TEST_P(NastyJoint, IsRefusedWithItsMendWhichWorks) {
  const Nasty& nasty = GetParam();
  const auto refused = compile(nasty.part(), nasty.toml);
  ASSERT_FALSE(refused) << "it was compiled";
  EXPECT_THAT(refused.error().to_string(), HasSubstr(nasty.says));
  const auto mended = compile(good(), nasty.mended_toml);
  ASSERT_TRUE(mended) << mended.error().to_string();
  EXPECT_GT(mended->report.structures[1].resolved_volume, 0);
}

std::vector<Nasty> nasty_joints() {
  const std::string part = kPart;
  const std::string region = part + kRegion;
  return {
      {"empty_file", [] { return std::string(); }, part, "export the surface again", part},
      {"no_face", [] { return std::string("OFF\n3 0 0\n0 0 0\n9 0 0\n0 9 0\n"); }, part,
       "export it again, or leave it out (--skip-refused)", part},
      {"one_triangle", [] { return std::string("OFF\n3 1 0\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n"); },
       part, "thicken = 1.0", part + "thicken = 1.0\n"},
      {"all_vertices_lost", [] { return ball(1); }, part, "export it again", part},
      {"half_of_the_vertices_lost", [] { return ball(2, "inf"); }, part,
       "vertices have coordinates that are not numbers; export it again", part},
      {"text", [] { return std::string("a surface, sir"); }, part, "export as PLY", part},
      {"duplicated_name", good, part + part, "give each structure, the filler and the body its own",
       part},
      {"unknown_tissue", good,
       "[[structure]]\nname = \"part\"\ntissue = \"muscel\"\nfile = "
       "\"part.off\"\n",
       "did you mean 'muscle'", part},
      {"region_without_size", good, region + "0.0\n", "must have a size greater than 0",
       region + "40.0\n"},
      {"region_below_0", good, region + "-5.0\n", "from 0 to", region + "40.0\n"},
      {"region_of_a_town", good, region + "1e6\n", "is larger than 10 m; give its size",
       region + "1e3\n"},
      {"region_at_the_moon", good,
       part + "[region_of_interest]\ncentre = [1e7, 0.0, 0.0]\nradius = 40.0\n",
       "lies more than 10 m from the origin", region + "40.0\n"},
      {"region_of_a_hair", good, region + "0.01\n", "enlarge it: radius = ", region + "55.0\n"},
      {"shell_of_nothing", good,
       part + "[[structure]]\nname = \"skin\"\ntissue = \"skin\"\nshell = {thickness = 0.0}\n",
       "must be greater than 0",
       part + "[[structure]]\nname = \"skin\"\ntissue = \"skin\"\nshell = {thickness = 2.0}\n"},
      {"needle_in_metres", good,
       part + "[[injection]]\nname = \"first\"\nentry = [0.0, 0.0, 0.03]\ntarget = [0.0, 0.0, "
              "0.005]\n",
       "unit of the file",
       part + "[[injection]]\nname = \"first\"\nentry = [0.0, 0.0, 30.0]\ntarget = [0.0, 0.0, "
              "5.0]\n"},
  };
}
INSTANTIATE_TEST_SUITE_P(Careless, NastyJoint, testing::ValuesIn(nasty_joints()),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

class CarelessJoint : public testing::Test {
 protected:
  CarelessJoint() : folder_("careless") {
    folder_.add_sphere("body", Vec3(0, 0, 0), 30);
    std::ofstream(folder_.path() / "part.off") << good();
    folder_.write_toml(kPart);
  }
  JointFile read() { return read_joint(folder_.path()).value(); }
  JointFolder folder_;
};

TEST_F(CarelessJoint, WithSomeLostVerticesIsRepaired) {
  std::ofstream(folder_.path() / "part.off") << ball(500);
  const auto outcome = compile_joint(read());
  ASSERT_TRUE(outcome) << outcome.error().to_string();
  EXPECT_FALSE(outcome->report.structures[1].repairs.empty());
  EXPECT_LT(std::abs(outcome->report.structures[1].volume_error()), 0.05);
}

TEST_F(CarelessJoint, WithFacetsLargerThanTheBodyIsRefused) {
  JointFile file = read();
  file.facet_size = 5;
  file.facet_distance = 0.5;
  const auto refused = compile_joint(file);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("the whole body measures 60 mm"));
}

TEST_F(CarelessJoint, WhoseBodyIsASheetIsNotToldToLeaveItOut) {
  std::ofstream(folder_.path() / "body.ply")
      << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n100 0 0\n0 100 0\n3 0 1 2\n";
  const auto refused = compile_joint(read());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("body: 1 piece is a sheet"));
  EXPECT_THAT(refused.error().message, testing::Not(HasSubstr("--skip-refused")));
  const JointCheck found = check_joint(read());
  EXPECT_FALSE(found.usable());
  EXPECT_EQ(found.findings.front().what, "body");
}

}  // namespace
}  // namespace artus
