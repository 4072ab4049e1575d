// SPDX-License-Identifier: AGPL-3.0-or-later
// Volume meshes: cubes beside each other, whose boundaries are known.
#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/import/cells/cell_types.h"
#include "artus/detail/anatomy/import/cells/volume_mesh.h"
#include "artus/detail/anatomy/import/cells/xml_arrays.h"
#include "artus/detail/anatomy/import/import_cells.h"
#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "tests/anatomy/import/cell_samples.h"

namespace artus {
namespace {

using test::make_cube_row;
using test::msh_of;
using test::vtu_of;
using test::VtuForm;
using testing::HasSubstr;

const std::vector<std::string> kNames{"Femur", "Subcutaneous fat"};

/// A row in every form that is read.
std::vector<std::string> all_forms(const test::CubeRow& row) {
  std::vector<std::string> all;
  for (const VtuForm form : {VtuForm::text, VtuForm::base64, VtuForm::raw})
    all.push_back(vtu_of(row, form));
  all.push_back(vtu_of(row, VtuForm::compressed, deflate_gzip));
  for (const bool is_new : {false, true}) all.push_back(msh_of(row, is_new, kNames));
  return all;
}

VolumeMesh read(const std::string& bytes) {
  const auto mesh = read_cells(bytes, "a");
  EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error().to_string());
  return mesh && *mesh ? **mesh : VolumeMesh();
}

TEST(Cells, EveryFormHoldsTheSameCellsAndMaterials) {
  const auto row = make_cube_row({2, 1, 1, 2});
  for (const std::string& bytes : all_forms(row)) {
    const VolumeMesh mesh = read(bytes);
    ASSERT_EQ(mesh.points.size(), row.points.size()) << mesh.format;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) EXPECT_EQ(mesh.points[i], row.points[i]);
    ASSERT_EQ(mesh.cells.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(mesh.cells[i].material, row.materials[i]) << mesh.format;
      EXPECT_EQ(mesh.cells[i].n, corners_of(CellShape::hexahedron));
    }
    EXPECT_TRUE(mesh.has_volume());
  }
}

TEST(Cells, BoundariesOfMaterialsAreClosedAndShareWhatLiesBetween) {
  const auto surfaces =
      find_boundaries(read(vtu_of(make_cube_row({2, 1, 1, 2}), VtuForm::text)), "a");
  ASSERT_TRUE(surfaces);
  ASSERT_EQ(surfaces->size(), 2U);
  EXPECT_NEAR(signed_volume((*surfaces)[0].mesh), 2, 1e-12);
  EXPECT_NEAR(signed_volume((*surfaces)[1].mesh), 2, 1e-12);
  EXPECT_NEAR(surface_area((*surfaces)[0].mesh), 10, 1e-12);
  EXPECT_NEAR(surface_area((*surfaces)[1].mesh), 12, 1e-12);
  // The two squares between them are parted by the same diagonals.
  std::size_t n_shared = 0;
  const auto centres = [](const SurfaceMesh& mesh) {
    std::vector<Vec3> all;
    for (const Triangle& t : mesh.triangles) all.push_back(triangle_centre(mesh, t));
    return all;
  };
  for (const Vec3& p : centres((*surfaces)[0].mesh))
    for (const Vec3& q : centres((*surfaces)[1].mesh)) n_shared += (p - q).norm() < 1e-12 ? 1 : 0;
  EXPECT_EQ(n_shared, 4U);
}

TEST(Cells, AllShapesAreWoundOutward) {
  VolumeMesh mesh;
  mesh.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0),
                 Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 1, 1), Vec3(0, 1, 1)};
  const std::vector<std::pair<int, std::vector<double>>> cells{{10, {0, 1, 3, 4}},
                                                               {10, {0, 3, 1, 4}},
                                                               {11, {0, 1, 3, 2, 4, 5, 7, 6}},
                                                               {12, {0, 1, 2, 3, 4, 5, 6, 7}},
                                                               {13, {0, 3, 1, 4, 7, 5}},
                                                               {14, {0, 1, 2, 3, 4}}};
  const std::vector<double> volumes{1. / 6, 1. / 6, 1, 1, 1. / 2, 1. / 3};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    mesh.cells.clear();
    const auto type = find_cell_type(vtk_cell_types(), cells[i].first);
    ASSERT_TRUE(type && add_cell(mesh, *type, cells[i].second, 1, "a"));
    const auto outer = find_outer_boundary(mesh, "a");
    ASSERT_TRUE(outer);
    EXPECT_NEAR(signed_volume(*outer), volumes[i], 1e-12) << cells[i].first;
  }
  EXPECT_FALSE(find_cell_type(gmsh_cell_types(), 99));
}

TEST(Cells, AJointIsMadeOfThemWhenTheUnitIsSaid) {
  ImportOptions options;
  const VolumeMesh mesh = read(msh_of(make_cube_row({2, 1, 1, 2}), true, kNames));
  EXPECT_THAT(import_cells(mesh, options, "a.msh", {}).error().message, HasSubstr("--units mm"));
  options.surface_unit = 1e-2;
  const auto joint = import_cells(mesh, options, "a.msh", {});
  ASSERT_TRUE(joint) << joint.error().to_string();
  ASSERT_EQ(joint->structures.size(), 1U);
  EXPECT_EQ(joint->structures[0].name, "femur");
  EXPECT_NEAR(signed_volume(joint->structures[0].mesh), 2e-6, 1e-15);
  EXPECT_NEAR(signed_volume(joint->body), 4e-6, 1e-15);  // fat reaches the skin
  EXPECT_FALSE(joint->body_is_assumed);
  EXPECT_TRUE(joint->is_partition);
  EXPECT_THAT(to_joint_toml(*joint), HasSubstr("partition = \"labels\""));
}

TEST(Cells, MaterialsWithoutNamesAreListed) {
  ImportOptions options;
  options.surface_unit = 1e-3;
  const VolumeMesh mesh = read(vtu_of(make_cube_row({5, 3, 3}), VtuForm::raw));
  EXPECT_THAT(import_cells(mesh, options, "a.vtu", {}).error().message,
              HasSubstr("('material'): 3 (2 cells), 5 (1 cells)"));
  options.names.labels = {{3, "tibia", ""}, {5, "femur", ""}};
  const auto joint = import_cells(mesh, options, "a.vtu", {});
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_EQ(joint->structures.size(), 2U);
  EXPECT_TRUE(joint->body_is_assumed);
}

TEST(Cells, ASurfaceOfVtkIsOnePart) {
  const std::string vtp =
      "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData><Piece><Points><DataArray "
      "type=\"Float32\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Polys>"
      "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 2 1 0 1 3 1 2 3 0 3 2"
      "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 6 9 12"
      "</DataArray></Polys></Piece></PolyData></VTKFile>";
  const auto parts = read_scene_parts(vtp, "bone.vtp", 1e-2);
  ASSERT_TRUE(parts) << parts.error().to_string();
  EXPECT_EQ(parts->front().name, "bone");
  EXPECT_NEAR(signed_volume(parts->front().mesh), 1e-6 / 6, 1e-12);
  const auto grid = vtu_of(make_cube_row({1}), VtuForm::text);
  EXPECT_THAT(read_scene_parts(grid, "a.vtu", 1e-3).error().message,
              HasSubstr("import it by itself"));
}

TEST(Cells, CutAndWrongFilesAreRefused) {
  const auto row = make_cube_row({2, 1});
  for (const std::string& bytes : all_forms(row))
    for (std::size_t n = bytes.size() / 4; n + 40 < bytes.size(); n += 37) {
      const auto cut = read_cells(bytes.substr(0, n), "a");
      const bool has_cells = cut && *cut && !(*cut)->cells.empty();  // a whole piece came before
      EXPECT_TRUE(has_cells || !cut || !*cut) << n;
    }
  const auto refusal = [](std::string bytes, const std::string& from, const std::string& to) {
    bytes.replace(bytes.find(from), from.size(), to);
    const auto read = read_cells(bytes, "a");
    return read ? std::string("it is read") : read.error().message;
  };
  const std::string text = vtu_of(row, VtuForm::text);
  const std::string old = msh_of(row, false, kNames);
  EXPECT_THAT(refusal(text, "\"ascii\">12 12", "\"ascii\">42 12"), HasSubstr("type 42"));
  EXPECT_THAT(refusal(text, "\"ascii\">0 1 2", "\"ascii\">0 1 99"), HasSubstr("point 99 of 12"));
  EXPECT_THAT(refusal(text, "UnstructuredGrid", "ImageData"), HasSubstr(".vtu"));
  EXPECT_THAT(refusal(vtu_of(row, VtuForm::raw), "UnstructuredGrid\"",
                      "UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\""),
              HasSubstr("zlib"));
  EXPECT_THAT(refusal(old, "2.2 0 8", "2.2 1 8"), HasSubstr("binary"));
  EXPECT_THAT(refusal(old, "$MeshFormat", "$NOD"), HasSubstr("version 1"));
  EXPECT_THAT(refusal(old, " 5 2 2", " 93 2 2"), HasSubstr("type 93"));
}

TEST(Cells, AFaceOfThreeCellsIsRefused) {
  auto row = make_cube_row({1, 1});
  row.cells.push_back(row.cells[0]);
  row.materials.push_back(1);
  EXPECT_THAT(find_boundaries(read(vtu_of(row, VtuForm::text)), "a").error().message,
              HasSubstr("more than two cells"));
}

TEST(XmlTags, AttributesAndEndsAreRead) {
  std::size_t at = 0;
  const std::string text = "<?xml?><!-- <a> --><A b='1' c = \"x>\"/></A>";
  const auto first = next_tag("<A b='1' c = \"x\"/></A>", at);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->is_empty);
  EXPECT_EQ(first->attribute("b"), "1");
  EXPECT_EQ(first->attribute("c"), "x");
  EXPECT_EQ(first->attribute("d"), "");
  at = 0;
  EXPECT_EQ(next_tag(text, at)->name, "A");
}

}  // namespace
}  // namespace artus
