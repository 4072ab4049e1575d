// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/repair.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_distance.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "tests/anatomy/surfaces/surface_samples.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

using testing::HasSubstr;

const RepairAction* action_of(const RepairOutcome& outcome, RepairKind kind) {
  for (const auto& a : outcome.actions)
    if (a.kind == kind) return &a;
  return nullptr;
}

void expect_closed(const SurfaceMesh& mesh) {
  const auto edges = count_edges(mesh);
  EXPECT_EQ(edges.open, 0U);
  EXPECT_EQ(edges.non_manifold, 0U);
  for (const auto& d : find_defects(mesh, {.self_intersections = false}))
    EXPECT_EQ(severity_of(d.kind), DefectSeverity::note) << to_string(d.kind) << ": " << d.message;
}

SurfaceMesh read_bad(const std::string& kind) {
  return read_surface(artus::test::source_dir() / "tests/data/bad" / (kind + ".off"), 1e-3).value();
}

TEST(Repair, SoundSurfaceComesBackUnchanged) {
  const auto mesh = make_cube(Vec3(0.1, 0.2, 0.3), 0.01);
  const auto out = repair_surface(mesh);
  ASSERT_TRUE(out);
  EXPECT_TRUE(out->actions.empty());
  EXPECT_EQ(out->mesh.triangles, mesh.triangles);
  EXPECT_EQ(out->mesh.vertices, mesh.vertices);
}

TEST(Repair, EveryRepairableBadFileEndsAsASoundCube) {
  for (const char* kind : {"degenerate_face", "duplicate_face", "unwelded_vertex", "open_edge",
                           "inconsistent_orientation", "inward_winding", "pillow_component"}) {
    SCOPED_TRACE(kind);
    const auto out = repair_surface(read_bad(kind));
    ASSERT_TRUE(out) << out.error().to_string();
    EXPECT_FALSE(out->actions.empty());
    expect_closed(out->mesh);
    EXPECT_NEAR(out->volume, 8e-6, 1e-12);
  }
}

TEST(Repair, BodiesThatTouchInAnEdgeOrAPointAreSeparated) {
  for (const char* kind : {"non_manifold_edge", "non_manifold_vertex"}) {
    SCOPED_TRACE(kind);
    const auto mesh = read_bad(kind);
    const auto out = repair_surface(mesh);
    ASSERT_TRUE(out) << out.error().to_string();
    expect_closed(out->mesh);
    EXPECT_NEAR(out->volume, signed_volume(mesh), 1e-12);
    EXPECT_NE(action_of(*out, RepairKind::split_vertices), nullptr);
  }
}

TEST(Repair, OpenTubeGetsTwoCaps) {
  const auto out = repair_surface(make_tube(12, 9, 0.003, 0.05));
  ASSERT_TRUE(out) << out.error().to_string();
  const auto* caps = action_of(*out, RepairKind::capped_ends);
  ASSERT_NE(caps, nullptr);
  EXPECT_EQ(caps->count, 2U);
  const double area = 6 * std::sin(std::numbers::pi / 6) * 0.003 * 0.003;  // regular 12-gon
  EXPECT_NEAR(caps->amount, 2 * area, 1e-9);
  EXPECT_NEAR(out->volume, area * 0.05, 1e-12);
  expect_closed(out->mesh);
}

TEST(Repair, SeamsApartByQuantisationAreSewnNotCapped) {
  auto mesh = make_tube(16, 5, 0.02, 0.05);
  const auto half = mesh.triangles.size() / 2;
  // The upper half gets its own copies of the seam's vertices, 0.03 mm away.
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t k = 0; k < 16; ++k)
    mesh.vertices.push_back(mesh.vertices[32 + k] + Vec3(2e-5, -1e-5, 2e-5));
  for (std::size_t f = half; f < mesh.triangles.size(); ++f)
    for (auto& v : mesh.triangles[f])
      if (v >= 32 && v < 48) v = v - 32 + n;
  const auto out = repair_surface(mesh);
  ASSERT_TRUE(out) << out.error().to_string();
  expect_closed(out->mesh);
  ASSERT_NE(action_of(*out, RepairKind::welded_vertices), nullptr);
  EXPECT_EQ(action_of(*out, RepairKind::welded_vertices)->count, 16U);
  EXPECT_LE(action_of(*out, RepairKind::welded_vertices)->amount, 0.0500001e-3);
  EXPECT_EQ(action_of(*out, RepairKind::capped_ends)->count, 2U);
}

TEST(Repair, SheetIsRefusedOrMadeAPlateWhenAsked) {
  const auto sheet = read_bad("zero_thickness_sheet");
  const auto refused = repair_surface(sheet);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::defective);
  EXPECT_THAT(refused.error().message, HasSubstr("thicken = 1.0"));
  const auto plate = repair_surface(sheet, {.thicken = 1e-3});
  ASSERT_TRUE(plate) << plate.error().to_string();
  expect_closed(plate->mesh);
  EXPECT_NEAR(plate->volume, surface_area(sheet) * 1e-3, 0.01 * surface_area(sheet) * 1e-3);
}

TEST(Repair, MoebiusStripIsRefusedWithItsReason) {
  SurfaceMesh strip;
  constexpr std::uint32_t kN = 24;
  for (std::uint32_t k = 0; k < kN; ++k) {
    const double a = 2 * std::numbers::pi * k / kN;
    for (const double w : {-0.01, 0.01})
      strip.vertices.emplace_back((0.05 + w * std::cos(a / 2)) * std::cos(a),
                                  (0.05 + w * std::cos(a / 2)) * std::sin(a), w * std::sin(a / 2));
  }
  for (std::uint32_t k = 0; k < kN; ++k) {
    const std::uint32_t a = 2 * k;
    const std::uint32_t b = 2 * k + 1;
    const std::uint32_t c = k + 1 < kN ? 2 * k + 2 : 1;
    const std::uint32_t d = k + 1 < kN ? 2 * k + 3 : 0;
    strip.triangles.push_back({a, c, b});
    strip.triangles.push_back({b, c, d});
  }
  const auto out = repair_surface(strip);
  ASSERT_FALSE(out);
  EXPECT_THAT(out.error().message, HasSubstr("only one side"));
}

TEST(Repair, NothingAndTooMuchAreRefused) {
  EXPECT_FALSE(repair_surface({}));
  EXPECT_FALSE(repair_surface(make_cube(Vec3::Zero(), 1), {.max_triangles = 11}));
  auto half = make_cube(Vec3::Zero(), 0.01);
  half.triangles.resize(2);
  EXPECT_FALSE(repair_surface(half));
}

TEST(Repair, WrapOnRequestStaysNearTheSurface) {
  const auto out = repair_surface(make_cube(Vec3::Zero(), 0.02), {.wrap = WrapPolicy::always});
  ASSERT_TRUE(out) << out.error().to_string();
  const auto* wrapped = action_of(*out, RepairKind::wrapped);
  ASSERT_NE(wrapped, nullptr);
  EXPECT_LT(wrapped->amount, 0.5e-3);
  EXPECT_NEAR(out->volume, 64e-6, 0.02 * 64e-6);
  expect_closed(out->mesh);
}

TEST(Repair, WrapOfASlenderBoneKeepsItsVolume) {
  const auto bone = repair_surface(make_tube(32, 40, 0.01, 0.25)).value();
  const auto out = repair_surface(bone.mesh, {.wrap = WrapPolicy::always});
  ASSERT_TRUE(out) << out.error().to_string();
  EXPECT_NEAR(out->volume, bone.volume, 0.02 * bone.volume);
  EXPECT_TRUE(find_self_intersections(out->mesh).empty());
  EXPECT_LT(measure_distance(bone.mesh, out->mesh).max, 1e-3);
  expect_closed(out->mesh);
}

TEST(Repair, FlapOnAnEdgeIsDroppedAndTheRestKept) {
  auto mesh = make_cube(Vec3::Zero(), 0.01);
  const auto apex = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(mesh.vertices[0] + Vec3(0.01, -1e-4, -1e-4));
  mesh.triangles.push_back({0, 1, apex});
  const auto out = repair_surface(mesh);
  ASSERT_TRUE(out) << out.error().to_string();
  EXPECT_EQ(action_of(*out, RepairKind::wrapped), nullptr);
  ASSERT_NE(action_of(*out, RepairKind::dropped_fragments), nullptr);
  EXPECT_NEAR(out->volume, 8e-6, 1e-12);
  expect_closed(out->mesh);
}

/// A tendon that lies around a bone: `angle` of a cylinder's wall, radius and length in m.
SurfaceMesh make_bent_sheet(double angle, double radius, double length) {
  SurfaceMesh sheet;
  constexpr std::uint32_t kRows = 12;
  constexpr std::uint32_t kColumns = 24;
  for (std::uint32_t i = 0; i <= kRows; ++i)
    for (std::uint32_t j = 0; j <= kColumns; ++j) {
      const double a = angle * i / kRows;
      sheet.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a),
                                  length * j / kColumns);
    }
  for (std::uint32_t i = 0; i < kRows; ++i)
    for (std::uint32_t j = 0; j < kColumns; ++j) {
      const std::uint32_t a = i * (kColumns + 1) + j;
      sheet.triangles.push_back({a, a + kColumns + 2, a + 1});
      sheet.triangles.push_back({a, a + kColumns + 1, a + kColumns + 2});
    }
  return sheet;
}

class BentSheet : public testing::TestWithParam<double> {};

TEST_P(BentSheet, IsRefusedOrMadeAPlateNotABody) {
  const auto sheet = make_bent_sheet(GetParam(), 0.02, 0.05);
  const auto refused = repair_surface(sheet);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("thicken"));
  const auto plate = repair_surface(sheet, {.thicken = 1e-3});
  ASSERT_TRUE(plate) << plate.error().to_string();
  EXPECT_EQ(action_of(*plate, RepairKind::capped_ends), nullptr);
  EXPECT_NEAR(plate->volume, surface_area(sheet) * 1e-3, 0.02 * surface_area(sheet) * 1e-3);
  expect_closed(plate->mesh);
}
INSTANTIATE_TEST_SUITE_P(Angles, BentSheet, testing::Values(0.2, 0.8, 1.8, 3.1));

TEST(Repair, CavityKeepsItsInwardWinding) {
  auto mesh = make_cube(Vec3::Zero(), 0.02);
  append_mesh(mesh, make_cube(Vec3::Zero(), 0.01));  // wound outward: wrong for a cavity
  const auto out = repair_surface(mesh);
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->volume, (64 - 8) * 1e-6, 1e-12);
}

}  // namespace
}  // namespace artus
