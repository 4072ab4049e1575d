// SPDX-License-Identifier: AGPL-3.0-or-later
// The test cases of the real shoulder's own README: what a good importer has to hold.
#include <cmath>

#include <gmock/gmock.h>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/repair.h"
#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_distance.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "artus/detail/core/units.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

using testing::HasSubstr;

class RealRepair : public testing::Test {
 protected:
  void SetUp() override {
    if (folder_.empty()) GTEST_SKIP() << "the real shoulder is not at hand";
  }
  [[nodiscard]] SurfaceMesh read(const std::string& name) const {
    return read_surface(folder_ / name, 1e-3).value();
  }
  static void expect_closed(const SurfaceMesh& mesh) {
    const auto edges = count_edges(mesh);
    EXPECT_EQ(edges.open, 0U);
    EXPECT_EQ(edges.non_manifold, 0U);
  }
  static double largest_distance(const std::vector<Vec3>& points, const SurfaceMesh& to) {
    const DistanceTree tree(to);
    double largest = 0;
    for (const Vec3& p : points) largest = std::max(largest, tree.distance(p, 1));
    return largest;
  }
  static std::size_t pieces_of(const SurfaceMesh& mesh) {
    return find_pieces(mesh, make_edge_uses(mesh)).n;
  }
  static const RepairAction* find_action(const RepairOutcome& outcome, RepairKind kind) {
    for (const auto& a : outcome.actions)
      if (a.kind == kind) return &a;
    return nullptr;
  }

 private:
  std::filesystem::path folder_ = real_shoulder_folder();
};

TEST_F(RealRepair, InfraspinatusIsAcceptedUnchanged) {
  const auto mesh = read("m_infraspinatus.ply");
  EXPECT_TRUE(find_defects(mesh).empty());
  const auto out = repair_surface(mesh);
  ASSERT_TRUE(out);
  EXPECT_TRUE(out->actions.empty());
  EXPECT_EQ(out->mesh.triangles, mesh.triangles);
  EXPECT_NEAR(out->volume / kCubicCentimetre, 110.40, 0.01);
}

TEST_F(RealRepair, ThreeVersionsOfFourMusclesCloseToTheSameBody) {
  const struct {
    const char* name;
    double volume;
  } muscles[] = {{"deltoid_acromial", 92.35},
                 {"infraspinatus", 110.40},
                 {"biceps_long", 99.74},
                 {"deltoid_spinal", 173.23}};
  for (const auto& m : muscles) {
    const auto truth = read(std::string("m_") + m.name + ".ply");
    for (const char* version : {"ahercracked", "zanatomy"}) {
      SCOPED_TRACE(std::string(m.name) + " " + version);
      const auto out =
          repair_surface(read(std::string("raw/oracle_") + m.name + "_" + version + ".stl"));
      ASSERT_TRUE(out) << out.error().to_string();
      expect_closed(out->mesh);
      EXPECT_NEAR(out->volume / kCubicCentimetre, m.volume, 0.01 * m.volume);
    }
    const auto accepted = repair_surface(truth);
    ASSERT_TRUE(accepted) << accepted.error().to_string();
    expect_closed(accepted->mesh);
    EXPECT_NEAR(accepted->volume / kCubicCentimetre, m.volume, 0.01 * m.volume);
  }
}

TEST_F(RealRepair, RepairMovesNoSurfaceByMoreThanHalfAMillimetre) {
  for (const char* name : {"raw/oracle_infraspinatus_ahercracked.stl",
                           "raw/oracle_biceps_long_ahercracked.stl", "raw/za_Scapula_r.stl"}) {
    const auto mesh = read(name);
    const auto out = repair_surface(mesh);
    ASSERT_TRUE(out) << name << ": " << out.error().to_string();
    EXPECT_LT(measure_distance(mesh, out->mesh).max, 0.5e-3) << name;
  }
}

TEST_F(RealRepair, RepairedOraclesLieOnTheirOriginals) {
  for (const char* name : {"deltoid_acromial", "infraspinatus", "biceps_long", "deltoid_spinal"}) {
    for (const char* version : {"ahercracked", "zanatomy"}) {
      SCOPED_TRACE(std::string(name) + " " + version);
      const auto mesh = read(std::string("raw/oracle_") + name + "_" + version + ".stl");
      const auto out = repair_surface(mesh);
      ASSERT_TRUE(out) << out.error().to_string();
      EXPECT_LT(largest_distance(mesh.vertices, out->mesh), 0.5e-3);
      EXPECT_LT(largest_distance(out->mesh.vertices, mesh), 0.5e-3);
      const auto both_ways = measure_distance(mesh, out->mesh);
      EXPECT_LT(both_ways.percentile95, 0.05e-3);
      EXPECT_LT(both_ways.max, 0.52e-3) << "within a triangle; 0.513 mm at one lip of a crack";
    }
  }
}

TEST_F(RealRepair, RawHumerusLosesItsFlapAndIsNotWrapped) {
  const auto mesh = read("raw/za_Humerus_r.stl");
  const auto out = repair_surface(mesh);
  ASSERT_TRUE(out) << out.error().to_string();
  expect_closed(out->mesh);
  EXPECT_EQ(find_action(*out, RepairKind::wrapped), nullptr);
  const double truth = repair_surface(read("b_humerus.ply")).value().volume;
  EXPECT_NEAR(out->volume, truth, 0.01 * truth);
}

TEST_F(RealRepair, AxillaryArteryIsTurnedAndGetsTwoCaps) {
  const auto out = repair_surface(read("a_axillary.ply"));
  ASSERT_TRUE(out) << out.error().to_string();
  expect_closed(out->mesh);
  ASSERT_NE(find_action(*out, RepairKind::capped_ends), nullptr);
  EXPECT_EQ(find_action(*out, RepairKind::capped_ends)->count, 2U);
  EXPECT_NE(find_action(*out, RepairKind::turned_pieces), nullptr);
  EXPECT_NEAR(out->volume / kCubicCentimetre, 1.27, 0.02);
}

TEST_F(RealRepair, SuprascapularNerveBecomesFiveClosedTubes) {
  const auto out = repair_surface(read("n_suprascapular.ply"));
  ASSERT_TRUE(out) << out.error().to_string();
  expect_closed(out->mesh);
  EXPECT_EQ(pieces_of(out->mesh), 5U);
  EXPECT_EQ(find_action(*out, RepairKind::capped_ends)->count, 10U);
}

TEST_F(RealRepair, SubscapularisClosesWithAReportOfWhatWasFilled) {
  const auto mesh = read("m_subscapularis.ply");
  const auto out = repair_surface(mesh);
  ASSERT_TRUE(out) << out.error().to_string();
  expect_closed(out->mesh);
  EXPECT_NEAR(out->volume / kCubicCentimetre, 35.5, 0.02 * 35.5);
  EXPECT_EQ(out->self_intersections, find_self_intersections(out->mesh).size());
  EXPECT_EQ(out->self_intersections, 0U);
  EXPECT_NE(find_action(*out, RepairKind::welded_vertices), nullptr);
}

TEST_F(RealRepair, RhomboidMinorEndsRepairedOrRefusedWithReasons) {
  const auto out = repair_surface(read("m_rhomboid_minor.ply"));
  if (!out) {
    EXPECT_EQ(out.error().code, ErrorCode::defective);
    EXPECT_FALSE(out.error().message.empty());
  } else {
    expect_closed(out->mesh);
  }
}

TEST_F(RealRepair, CoracoAcromialLigamentIsRefusedOrMadeAPlate) {
  const auto mesh = read("l_coraco_acromial.ply");
  const auto refused = repair_surface(mesh);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("thickness"));
  const auto plate = repair_surface(mesh, {.thicken = 1.5e-3});
  ASSERT_TRUE(plate) << plate.error().to_string();
  expect_closed(plate->mesh);
}

TEST_F(RealRepair, AscendingTrapeziusLosesItsPillows) {
  const auto mesh = read("m_trapezius_ascending.ply");
  EXPECT_EQ(pieces_of(mesh), 44U);
  const auto out = repair_surface(mesh, {.remove_self_intersections = false});
  ASSERT_TRUE(out) << out.error().to_string();
  EXPECT_EQ(find_action(*out, RepairKind::dropped_pillows)->count, 19U);
  EXPECT_EQ(pieces_of(out->mesh), 25U);
}

TEST_F(RealRepair, FacesStoredTwiceAreKeptOnce) {
  const auto out =
      repair_surface(read("raw/za_Common_palmar_digital_branches_of_ulnar_nerve_r.stl"));
  ASSERT_TRUE(out) << out.error().to_string();
  expect_closed(out->mesh);
}

}  // namespace
}  // namespace artus
