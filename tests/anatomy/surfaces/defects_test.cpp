// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/defects.h"

#include <cmath>
#include <limits>
#include <set>

#include <gmock/gmock.h>

#include "artus/detail/anatomy/compile/check/joint_defects.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "tests/anatomy/surfaces/surface_samples.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

using testing::HasSubstr;
using Kinds = std::set<std::string>;

const std::filesystem::path kBad = artus::test::source_dir() / "tests/data/bad";

Kinds kinds_of(const std::vector<Defect>& defects) {
  Kinds kinds;
  for (const auto& d : defects) {
    kinds.insert(to_string(d.kind));
    EXPECT_GT(d.count, 0U) << d.message;
    EXPECT_FALSE(d.message.empty());
  }
  return kinds;
}

const Defect* find_kind(const std::vector<Defect>& defects, DefectKind kind) {
  for (const auto& d : defects)
    if (d.kind == kind) return &d;
  return nullptr;
}

std::vector<DefectKind> kinds_from_to(DefectKind first, DefectKind last) {
  std::vector<DefectKind> kinds;
  for (int k = static_cast<int>(first); k <= static_cast<int>(last); ++k)
    kinds.push_back(static_cast<DefectKind>(k));
  return kinds;
}

/// What a bad file has besides the defect it is named for.
Kinds expected_of(const std::string& kind) {
  Kinds kinds{kind};
  if (kind == "non_finite_coordinate" || kind == "unwelded_vertex" ||
      kind == "zero_thickness_sheet")
    kinds.insert("open_edge");
  if (kind == "non_manifold_vertex") kinds.insert("several_components");
  return kinds;
}

class EverySurfaceDefect : public testing::TestWithParam<DefectKind> {};

TEST_P(EverySurfaceDefect, IsReportedForItsFileAndNothingElseIs) {
  const std::string kind = to_string(GetParam());
  const auto file = kBad / (kind + ".off");
  ASSERT_TRUE(std::filesystem::exists(file)) << "each kind of defect needs its bad file";
  const auto mesh = read_surface(file, 1e-3);
  if (GetParam() == DefectKind::index_out_of_range) {
    ASSERT_FALSE(mesh) << "a file is refused at once, at its line";
    EXPECT_THAT(mesh.error().to_string(), HasSubstr(".off:24: the face names vertex 99 of 8"));
    return;
  }
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  EXPECT_EQ(kinds_of(find_defects(*mesh)), expected_of(kind));
}

std::string name_of(const testing::TestParamInfo<DefectKind>& info) {
  return to_string(info.param);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EverySurfaceDefect,
                         testing::ValuesIn(kinds_from_to(DefectKind::empty, kLastSurfaceDefect)),
                         name_of);

class EveryJointDefect : public testing::TestWithParam<DefectKind> {};

TEST_P(EveryJointDefect, IsReportedForItsJointAndNothingElseIs) {
  const std::string kind = to_string(GetParam());
  ASSERT_TRUE(std::filesystem::exists(kBad / kind / "joint.toml"))
      << "each kind of defect needs its bad joint";
  auto joint = read_joint(kBad / kind);
  if (GetParam() == DefectKind::unknown_tissue) {
    ASSERT_FALSE(joint) << "a file is refused at once, at its line";
    EXPECT_THAT(joint.error().message, HasSubstr("unknown tissue 'bones' (did you mean 'bone'?)"));
    joint = read_joint(kBad / "crossing_layers");
    ASSERT_TRUE(joint);
    joint->structures[1] = joint->structures[0];
    joint->structures[0].tissue = "bones";
    joint->structures.resize(1);
  }
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_EQ(kinds_of(find_joint_defects(*joint)), Kinds{kind});
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryJointDefect,
                         testing::ValuesIn(kinds_from_to(DefectKind::unreadable_file, kLastDefect)),
                         name_of);

TEST(Defects, ACubeHasNone) {
  EXPECT_TRUE(find_defects(make_cube(Vec3::Zero(), 0.01)).empty());
}

TEST(Defects, FaceOfAMissingVertexIsReportedInMemory) {
  auto mesh = make_cube(Vec3::Zero(), 0.01);
  mesh.triangles.push_back({0, 1, 99});
  EXPECT_EQ(kinds_of(find_defects(mesh)), Kinds{"index_out_of_range"});
}

TEST(Defects, AllKindsOfOneMeshAreListedAtOnce) {
  auto mesh = make_cube(Vec3::Zero(), 0.01);
  mesh.triangles.pop_back();
  mesh.triangles.push_back(mesh.triangles[0]);
  mesh.triangles.push_back({3, 3, 4});
  mesh.vertices.emplace_back(std::nan(""), 0, 0);
  append_mesh(mesh, make_cube(Vec3(0.1, 0, 0), 0.01));
  EXPECT_EQ(kinds_of(find_defects(mesh)),
            (Kinds{"non_finite_coordinate", "degenerate_face", "duplicate_face", "open_edge",
                   "several_components"}));
}

TEST(Defects, ACavityMayBeWoundInward) {
  auto mesh = make_cube(Vec3::Zero(), 0.02);
  auto cavity = make_cube(Vec3::Zero(), 0.01);
  for (auto& t : cavity.triangles) std::swap(t[1], t[2]);
  append_mesh(mesh, cavity);
  EXPECT_EQ(kinds_of(find_defects(mesh)), Kinds{"several_components"});
}

TEST(Defects, TheEdgesAndHolesAreCounted) {
  const auto defects = find_defects(make_tube(12, 5, 0.003, 0.05));
  const auto* open = find_kind(defects, DefectKind::open_edge);
  ASSERT_NE(open, nullptr);
  EXPECT_EQ(open->count, 24U);
  EXPECT_THAT(open->message, HasSubstr("around 2 holes"));
}

TEST(Defects, NarrowTubeEndIsNoCrack) {
  const auto defects = find_defects(make_tube(12, 5, 0.0003, 0.05));
  EXPECT_EQ(find_kind(defects, DefectKind::unwelded_vertex), nullptr);
}

TEST(Defects, IntersectionsAgreeWithBruteForceOverCrossedCubes) {
  auto mesh = make_cube(Vec3::Zero(), 0.01);
  append_mesh(mesh, make_cube(Vec3(0.007, 0.006, 0.0055), 0.01));
  const auto defects = find_defects(mesh);
  const auto* crossing = find_kind(defects, DefectKind::self_intersection);
  ASSERT_NE(crossing, nullptr);
  // Two cubes displaced along all three axes: their surfaces meet in a closed line, so each pair
  // that is found must be of one face of each cube.
  for (const auto& [a, b] : find_self_intersections(mesh)) {
    EXPECT_LT(a, 12U);
    EXPECT_GE(b, 12U);
  }
  EXPECT_EQ(find_self_intersections(mesh, 2).size(), 2U);
}

TEST(Defects, TheRealManubriumInItsWrongUnitIsAnOutlier) {
  const auto folder = real_shoulder_folder();
  if (folder.empty()) GTEST_SKIP() << "the real shoulder is not at hand";
  std::vector<NamedSurface> surfaces;
  for (const char* name : {"b_manubrium", "b_sternum_body", "b_clavicle", "b_humerus", "b_scapula",
                           "b_rib1", "b_rib2", "m_supraspinatus", "m_deltoid_acromial"}) {
    auto mesh = read_surface(folder / (std::string(name) + ".ply"), 1e-3);
    ASSERT_TRUE(mesh) << mesh.error().to_string();
    surfaces.push_back({name, name[0] == 'b' ? "bone" : "muscle", std::move(*mesh), false, {}});
  }
  EXPECT_TRUE(find_outliers(surfaces).empty());
  for (Vec3& p : surfaces[0].mesh.vertices) p /= 27.66;
  const auto defects = find_outliers(surfaces);
  EXPECT_EQ(kinds_of(defects), (Kinds{"size_outlier", "place_outlier"}));
  for (const Defect& d : defects) EXPECT_EQ(severity_of(d.kind), DefectSeverity::doubtful);
  for (const auto& d : defects) EXPECT_EQ(d.structure, "b_manubrium");
  surfaces[0].has_own_unit = true;  // its author says that it is so small
  EXPECT_EQ(kinds_of(find_outliers(surfaces)), Kinds{"place_outlier"});
}

TEST(Defects, APatchAlongASeamIsNoSheet) {
  auto mesh = make_cube(Vec3::Zero(), 0.01);  // the upper side stands apart by 0.02 mm
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t v = 4; v < 8; ++v)
    mesh.vertices.push_back(mesh.vertices[v] + Vec3(0, 0, 2e-5));
  mesh.triangles[2] = {n, n + 1, n + 3};
  mesh.triangles[3] = {n, n + 3, n + 2};
  const auto defects = find_defects(mesh);
  EXPECT_NE(find_kind(defects, DefectKind::unwelded_vertex), nullptr);
  EXPECT_EQ(find_kind(defects, DefectKind::zero_thickness_sheet), nullptr);
  mesh.vertices[n] += Vec3(-0.01, 0, 0.002);  // and now by more than a crack
  for (std::uint32_t v = n; v < n + 4; ++v) mesh.vertices[v] += Vec3(0, 0, 0.002);
  EXPECT_NE(find_kind(find_defects(mesh), DefectKind::zero_thickness_sheet), nullptr);
}

TEST(Defects, WhatSticksOutOfTheBodyIsSaidToBeCutOff) {
  const std::vector<NamedSurface> surfaces{
      {"body", "fat", make_cube(Vec3::Zero(), 0.02), false, {}},
      {"knee", "bone", make_cube(Vec3(0.02, 0.001, 0.002), 0.01), false, {}}};
  const auto defects = find_crossings(surfaces);
  ASSERT_EQ(defects.size(), 1U);
  EXPECT_THAT(defects[0].message, HasSubstr("outside the body's surface is cut off"));
}

TEST(FindCrossings, MembersOfOnePartitionAreNotAsked) {
  const auto crossings = [](const char* a, const char* b) {
    return find_crossings({{"a", "bone", make_cube(Vec3::Zero(), 0.02), false, a},
                           {"b", "bone", make_cube(Vec3(0.02, 0.001, 0.002), 0.01), false, b}})
        .size();
  };
  EXPECT_EQ(crossings("labels", "labels"), 0U);
  EXPECT_EQ(crossings("labels", "others"), 1U);
  EXPECT_EQ(crossings("", ""), 1U);
}

}  // namespace
}  // namespace artus
