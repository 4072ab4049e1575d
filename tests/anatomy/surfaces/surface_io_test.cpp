// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/surface_io.h"

#include <clocale>
#include <cmath>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>

#include "artus/detail/anatomy/surfaces/foreign_format.h"
#include "artus/detail/anatomy/surfaces/surface_io_formats.h"
#include "artus/detail/core/text_file.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

using testing::HasSubstr;

void append_le(std::string& out, const void* value, std::size_t size) {
  out.append(static_cast<const char*>(value), size);
}

std::string binary_stl(const std::string& header, std::uint32_t promised,
                       const std::vector<std::array<float, 9>>& facets) {
  std::string out = header;
  out.resize(80, ' ');
  append_le(out, &promised, 4);
  for (const auto& f : facets) {
    out.append(12, '\0');
    append_le(out, f.data(), 36);
    out.append(2, '\0');
  }
  return out;
}

const char* const kAsciiStl =
    "solid cube\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1e0 0 0\n"
    "   vertex 0 +1.0 0\n  endloop\n endfacet\nendsolid cube\n";

TEST(SurfaceIo, EveryFormatGivesTheMeshBack) {
  const auto mesh = make_cube(Vec3(0.1, -0.2, 1.3), 0.01);
  for (const char* name : {"cube.stl", "cube.ply", "cube.obj", "cube.off"}) {
    const auto file = std::filesystem::path(testing::TempDir()) / name;
    ASSERT_TRUE(write_surface(mesh, file, 1e-3));
    const auto back = read_surface(file, 1e-3);
    ASSERT_TRUE(back) << back.error().to_string();
    EXPECT_EQ(back->vertices.size(), 8U) << name;
    EXPECT_EQ(back->triangles.size(), 12U) << name;
    EXPECT_NEAR(signed_volume(*back), 8e-6, 1e-11) << name;
  }
}

TEST(SurfaceFormats, TextAndPlyKeepEveryBitOfACoordinate) {
  SurfaceMesh mesh = make_cube(Vec3(0.1, -0.2, 1.3) / 3, 0.01 / 7);
  const auto expect_same = [&mesh](const Result<SurfaceMesh>& back) {
    ASSERT_TRUE(back) << back.error().to_string();
    EXPECT_EQ(back->vertices, mesh.vertices);
    EXPECT_EQ(back->triangles, mesh.triangles);
  };
  expect_same(parse_ply(format_ply(mesh, 1), "a.ply"));
  expect_same(parse_obj(format_obj(mesh, 1), "a.obj"));
  expect_same(parse_off(format_off(mesh, 1), "a.off"));
}

TEST(SurfaceFormats, WhatIsWrittenAsStlIsKnownAsBinaryByItsLength) {
  const std::string bytes = format_stl(make_cube(Vec3::Zero(), 0.01), 1e-3);
  EXPECT_TRUE(is_binary_stl(bytes));
  EXPECT_FALSE(is_binary_stl(bytes.substr(0, bytes.size() - 1)));
  EXPECT_FALSE(is_binary_stl(kAsciiStl));
  EXPECT_EQ(parse_stl_ascii(kAsciiStl, "a.stl")->triangles.size(), 1U);
  EXPECT_EQ(parse_stl_binary(bytes, "a.stl")->triangles.size(), 12U);
}

TEST(SurfaceIo, UnitScalesCoordinates) {
  const auto mesh = parse_surface("v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n", "a.obj", 1e-2);
  ASSERT_TRUE(mesh);
  EXPECT_DOUBLE_EQ(mesh->vertices[1].x(), 0.1);
}

TEST(SurfaceIo, BinaryStlThatStartsWithSolidIsBinary) {
  const auto mesh =
      parse_surface(binary_stl("solid made by a careless exporter", 2,
                               {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, -0.0F, 0, 1, 0, -1, 0, 0}}),
                    "a.stl", 1);
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  EXPECT_EQ(mesh->triangles.size(), 2U);
  EXPECT_EQ(mesh->vertices.size(), 4U) << "-0 and 0 are one vertex";
}

TEST(SurfaceIo, AByteOrderMarkAndALineBreakAtTheEndDoNoHarm) {
  const std::string binary = binary_stl("cut here", 1, {{0, 0, 0, 1, 0, 0, 0, 1, 0}});
  const auto longer = parse_surface(binary + "\r\n", "a.stl", 1);
  ASSERT_TRUE(longer) << longer.error().to_string();
  EXPECT_EQ(longer->triangles.size(), 1U);
  EXPECT_FALSE(parse_surface(binary + std::string(50, ' '), "a.stl", 1)) << "a facet too many";
  const auto marked = parse_surface(std::string("\xEF\xBB\xBF") + kAsciiStl, "a.stl", 1);
  ASSERT_TRUE(marked) << marked.error().to_string();
  EXPECT_EQ(marked->triangles.size(), 1U);
}

TEST(SurfaceIo, ContentDecidesBeforeTheExtension) {
  const auto mesh = parse_surface(kAsciiStl, "wrong.ply", 1);
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  EXPECT_EQ(mesh->triangles.size(), 1U);
}

TEST(SurfaceIo, AsciiStlNamesTheLineOfTheFault) {
  std::string text = kAsciiStl;
  text.replace(text.find("1e0"), 3, "1,5");
  const auto mesh = parse_surface(text, "a.stl", 1);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::malformed);
  EXPECT_EQ(mesh.error().where, "a.stl:5");
  EXPECT_THAT(mesh.error().message, HasSubstr("point, not a comma"));
}

TEST(SurfaceIo, HostileCountsAreRefusedBeforeAllocating) {
  const auto stl = parse_surface(binary_stl("x", 0xfffffff0U, {}), "a.stl", 1);
  ASSERT_FALSE(stl);
  EXPECT_EQ(stl.error().code, ErrorCode::corrupt);
  const auto ply = parse_surface(
      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\n"
      "property double y\nproperty double z\nend_header\n",
      "a.ply", 1);
  ASSERT_FALSE(ply);
  EXPECT_EQ(ply.error().code, ErrorCode::corrupt);
  const auto off = parse_surface("OFF\n4000000000 4000000000 0\n", "a.off", 1);
  ASSERT_FALSE(off);
  EXPECT_EQ(off.error().code, ErrorCode::corrupt);
}

TEST(SurfaceIo, TruncatedFilesAreRefusedAtEveryLength) {
  const auto mesh = make_cube(Vec3::Zero(), 0.01);
  for (const char* name : {"t.stl", "t.ply"}) {
    const auto file = std::filesystem::path(testing::TempDir()) / name;
    ASSERT_TRUE(write_surface(mesh, file, 1e-3));
    const auto bytes = read_bytes(file);
    ASSERT_TRUE(bytes);
    for (std::size_t n = 0; n < bytes->size(); ++n)
      EXPECT_FALSE(parse_surface(bytes->substr(0, n), name, 1)) << name << " cut at " << n;
  }
}

TEST(SurfaceIo, BigEndianPlyWithPolygonsAndExtraPropertiesIsRead) {
  std::string ply =
      "ply\nformat binary_big_endian 1.0\ncomment c\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nproperty uchar red\nelement face 1\n"
      "property list uchar short vertex_index\nend_header\n";
  for (const std::array<float, 3>& v :
       {std::array<float, 3>{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}) {
    for (const float x : v) {
      std::array<char, 4> raw{};
      std::memcpy(raw.data(), &x, 4);
      ply.append(raw.rbegin(), raw.rend());
    }
    ply += '\x7f';
  }
  ply += std::string("\x04\x00\x00\x00\x01\x00\x02\x00\x03", 9);
  const auto mesh = parse_surface(ply, "a.ply", 1);
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  EXPECT_EQ(mesh->triangles.size(), 2U);
  EXPECT_DOUBLE_EQ(surface_area(*mesh), 4);
}

TEST(SurfaceIo, AsciiPlyIsRead) {
  const auto mesh = parse_surface(
      "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\n"
      "property float z\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n"
      "end_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
      "a.ply", 1);
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  EXPECT_EQ(mesh->triangles.size(), 1U);
}

TEST(SurfaceIo, ObjTakesNegativeIndicesPolygonsAndSlashes) {
  const auto mesh = parse_surface(
      "# made by hand\no x\nv 0 0 0 1\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
      "f 1/1/1 2//1 3/1 -1 # a square\nf -4 -3 \\\n -2\n",
      "a.obj", 1);
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  EXPECT_EQ(mesh->triangles.size(), 3U);
  EXPECT_DOUBLE_EQ(surface_area(*mesh), 1.5);
}

TEST(SurfaceIo, FaceOfAMissingVertexNamesBoth) {
  for (const auto& [text, name] :
       {std::pair<const char*, const char*>{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "a.obj"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n", "a.off"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n",
         "a.ply"}}) {
    const auto mesh = parse_surface(text, name, 1);
    ASSERT_FALSE(mesh) << name;
    EXPECT_EQ(mesh.error().code, ErrorCode::malformed);
    EXPECT_THAT(mesh.error().message, HasSubstr("names vertex 9")) << name;
  }
}

TEST(SurfaceIo, ADecimalCommaIsToldInEveryFormatOfText) {
  for (const auto& [text, name] :
       {std::pair<const char*, const char*>{"v 1,5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj"},
        {"OFF\n3 1 0\n1,5 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "a.off"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 1,5 0 0\n", "a.stl"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "1,5 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
         "a.ply"}}) {
    const auto mesh = parse_surface(text, name, 1);
    ASSERT_FALSE(mesh) << name;
    EXPECT_THAT(mesh.error().message, HasSubstr("decimals take a point, not a comma")) << name;
  }
  const auto gltf = parse_surface("{\"asset\": {\"version\": \"2.0\"}}", "a.gltf", 1);
  ASSERT_FALSE(gltf);
  EXPECT_EQ(gltf.error().code, ErrorCode::unsupported);
}

TEST(SurfaceIo, NonFiniteCoordinatesAreKept) {
  const auto mesh = parse_surface("OFF\n3 1 0\nnan 0 0\ninf 0 0\n0 1e999 0\n3 0 1 2\n", "a.off", 1);
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  for (const Vec3& p : mesh->vertices) EXPECT_FALSE(p.allFinite());
}

TEST(SurfaceIo, ReadingDoesNotDependOnTheLocale) {
  const char* old = std::setlocale(LC_NUMERIC, nullptr);  // NOLINT(concurrency-mt-unsafe)
  const std::string before = old == nullptr ? "C" : old;
  static_cast<void>(std::setlocale(LC_NUMERIC, "de_DE.UTF-8"));  // NOLINT(concurrency-mt-unsafe)
  const auto mesh = parse_surface("v 0.5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj", 1);
  static_cast<void>(std::setlocale(LC_NUMERIC, before.c_str()));  // NOLINT(concurrency-mt-unsafe)
  ASSERT_TRUE(mesh);
  EXPECT_DOUBLE_EQ(mesh->vertices[0].x(), 0.5);
}

TEST(SurfaceIo, WhatIsNoSurfaceIsRefusedWithWhatToDo) {
  EXPECT_THAT(parse_surface("glTF\2\0\0\0", "a.glb", 1).error().message, HasSubstr("STL or PLY"));
  EXPECT_EQ(parse_surface("", "a.stl", 1).error().code, ErrorCode::malformed);
  EXPECT_EQ(parse_surface("hello", "a.txt", 1).error().code, ErrorCode::unsupported);
  EXPECT_EQ(read_surface("/no/such/file.stl", 1).error().code, ErrorCode::not_found);
  EXPECT_EQ(read_surface(testing::TempDir(), 1).error().code, ErrorCode::unreadable);
  EXPECT_EQ(write_surface({}, "a.xyz", 1).error().code, ErrorCode::unsupported);
}

TEST(SurfaceIo, OtherFormatsAreNamedWithTheWayToWhatIsRead) {
  const auto told = [](const std::string& bytes, const std::string& name) {
    return parse_surface(bytes, name, 1).error().message;
  };
  EXPECT_THAT(told("NRRD0004\ntype: short\n", "a.nrrd"), HasSubstr("artus import"));
  EXPECT_THAT(told("\x1f\x8b\x08 and so on", "a.nii.gz"), HasSubstr("volume of voxels (NIfTI)"));
  EXPECT_THAT(told("<VTKFile type=\"UnstructuredGrid\">", "a.vtu"), HasSubstr("volume mesh"));
  EXPECT_THAT(told("$MeshFormat\n4.1 0 8\n", "a.msh"), HasSubstr("volume mesh (Gmsh)"));
  EXPECT_THAT(told("# vtk DataFile Version 3.0\n", "a.vtk"), HasSubstr("VTK"));
  EXPECT_THAT(told(std::string(128, '\0') + "DICM", "a"), HasSubstr("DICOM"));
  EXPECT_EQ(foreign_format("solid a\nfacet normal 0 0 1\n", "a.stl"), "");
  EXPECT_EQ(foreign_format("ply\n", "a.ply"), "");
  const auto folder = test::source_dir() / "../shared/cases/06-volume-meshes-and-label-maps";
  if (!std::filesystem::exists(folder)) return;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().filename() == "README") continue;
    EXPECT_THAT(read_surface(entry.path(), 1e-3).error().message,
                testing::AnyOf(HasSubstr("artus import"), HasSubstr("volume mesh")))
        << entry.path();
  }
}

TEST(SurfaceIo, EverySurfaceOfTheRealShoulderIsRead) {
  const auto folder = real_shoulder_folder();
  if (folder.empty()) GTEST_SKIP() << "the real shoulder is not at hand";
  std::size_t n = 0;
  for (const auto& where : {folder, folder / "raw"}) {
    for (const auto& entry : std::filesystem::directory_iterator(where)) {
      const auto ext = entry.path().extension();
      if (ext != ".ply" && ext != ".stl") continue;
      const auto mesh = read_surface(entry.path(), 1e-3);
      ASSERT_TRUE(mesh) << mesh.error().to_string();
      EXPECT_GT(mesh->triangles.size(), 1U) << entry.path();
      ++n;
    }
  }
  EXPECT_GE(n, 85U);
}

}  // namespace
}  // namespace artus
