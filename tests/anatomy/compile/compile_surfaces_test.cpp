// SPDX-License-Identifier: AGPL-3.0-or-later
// Surfaces as they come from files: repaired as declared, or refused by name.
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"

#include <gtest/gtest.h>

#include "artus/detail/anatomy/compile/check/joint_defects.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "tests/anatomy/compile/balls_joint.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

constexpr double kMm = 1e-3;

SurfaceMesh open_cube() {
  SurfaceMesh mesh = make_cube(Vec3::Zero(), 10 * kMm);
  mesh.triangles.pop_back();
  return mesh;
}

/// A joint of files in a folder of its own.
class SurfaceFiles : public test::TemporaryFolder {
 protected:
  Structure write(const std::string& name, const SurfaceMesh& mesh) {
    const auto written = write_surface(mesh, folder_ / (name + ".ply"), kMm);
    EXPECT_TRUE(written);
    Structure structure;
    structure.name = name;
    structure.tissue = "muscle";
    SurfaceFile file;
    file.file = name + ".ply";
    structure.shape = file;
    return structure;
  }
  JointFile joint(std::vector<Structure> structures) {
    JointFile file;
    file.name = "files";
    file.surface_folder = folder_;
    file.body = write("body", make_cube(Vec3::Zero(), 30 * kMm));
    file.structures = std::move(structures);
    Tissue muscle;
    muscle.name = "muscle";
    file.tissues = {muscle};
    return file;
  }
};

TEST(RepairAsDeclared, NoneLeavesASurfaceAsItIsAutoClosesIt) {
  SurfaceFile file;
  file.repair = "none";
  const auto untouched = repair_as_declared(open_cube(), file);
  ASSERT_TRUE(untouched);
  EXPECT_EQ(untouched->mesh.triangles.size(), 11U);
  EXPECT_TRUE(untouched->actions.empty());
  file.repair = "auto";
  const auto closed = repair_as_declared(open_cube(), file);
  ASSERT_TRUE(closed);
  EXPECT_NEAR(closed->volume, 8e-6, 1e-12) << "a cube of 20 mm";
  EXPECT_FALSE(closed->actions.empty());
}

TEST_F(SurfaceFiles, ArePreparedWithTheirThicknessAndTheirRepairsNoted) {
  const JointFile file = joint({write("cube", open_cube())});
  std::vector<StructureReport> reports(1);
  const auto prepared = prepare_surfaces(file, reports);
  ASSERT_TRUE(prepared) << prepared.error().to_string();
  ASSERT_TRUE(prepared->structures[0]);
  EXPECT_NEAR(prepared->structures[0]->thickness, 2 * 8e-6 / 24e-4, 1e-9) << "2 volume / area";
  EXPECT_FALSE(reports[0].repairs.empty());
  EXPECT_NEAR(prepared->structures[0]->tree.distance(Vec3::Zero(), 1), 10 * kMm, 1e-9);
}

TEST_F(SurfaceFiles, AConstructHasNoneAndARefusedOneIsNamedAndLeftOut) {
  SurfaceMesh sheet;
  sheet.vertices = {Vec3::Zero(), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0), Vec3(0.01, 0.01, 0)};
  sheet.triangles = {{0, 1, 2}, {1, 3, 2}};
  Structure shell;
  shell.name = "skin";
  shell.shape = ShellConstruct{"", 1 * kMm};
  const JointFile file = joint({write("sheet", sheet), shell});
  std::vector<StructureReport> reports(2);
  const auto prepared = prepare_surfaces(file, reports);
  ASSERT_TRUE(prepared) << prepared.error().to_string();
  EXPECT_FALSE(prepared->structures[0]);
  EXPECT_FALSE(prepared->structures[1]);
  EXPECT_FALSE(reports[0].refused.empty());
  EXPECT_TRUE(reports[1].refused.empty());
}

TEST_F(SurfaceFiles, AMissingFileIsAnErrorNotARefusal) {
  JointFile file = joint({write("cube", open_cube())});
  std::filesystem::remove(folder_ / "cube.ply");
  std::vector<StructureReport> reports(1);
  const auto prepared = prepare_surfaces(file, reports);
  ASSERT_FALSE(prepared);
  EXPECT_EQ(prepared.error().code, ErrorCode::not_found);
  const auto defects = find_joint_defects(file);
  ASSERT_EQ(defects.size(), 1U);
  EXPECT_EQ(defects[0].kind, DefectKind::unreadable_file);
  EXPECT_EQ(defects[0].structure, "cube");
}

TEST_F(SurfaceFiles, DefectsCarryTheNameOfTheirStructureAndProgressEndsAtOne) {
  JointFile file = joint(
      {write("cube", open_cube()), write("sound", make_cube(Vec3(0.02, 0.02, 0.02), 5 * kMm))});
  file.structures[1].tissue = "unobtainium";
  double last = -1;
  const auto defects =
      find_joint_defects(file, {}, [&last](std::string_view, double fraction) { last = fraction; });
  ASSERT_EQ(defects.size(), 2U);
  EXPECT_EQ(defects[0].kind, DefectKind::open_edge);
  EXPECT_EQ(defects[0].structure, "cube");
  EXPECT_EQ(defects[1].kind, DefectKind::unknown_tissue);
  EXPECT_EQ(defects[1].structure, "sound");
  EXPECT_EQ(last, 1);
}

}  // namespace
}  // namespace artus
