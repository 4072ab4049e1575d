// SPDX-License-Identifier: AGPL-3.0-or-later
// What a compilation says of itself: measures, warnings, report.
#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/anatomy/compile/check/compile_warnings.h"
#include "artus/detail/anatomy/compile/labels/compile_labels.h"
#include "artus/detail/anatomy/compile/labels/compile_report.h"
#include "artus/detail/anatomy/compile/mesh/compile_measure.h"
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"
#include "tests/anatomy/compile/balls_joint.h"
#include "tests/anatomy/compile/tet_samples.h"

namespace artus {
namespace {

using test::ball_volume;
using test::BallsJoint;

constexpr double kMm = 1e-3;

/// Two balls that overlap and a third that sticks out of the body.
BallsJoint make_joint() {
  return {30 * kMm,
          {{"a", "muscle", Vec3(-6 * kMm, 0, 0), 10 * kMm},
           {"b", "muscle", Vec3(6 * kMm, 0, 0), 10 * kMm},
           {"c", "muscle", Vec3(0, 28 * kMm, 0), 8 * kMm}}};
}

/// The volume that two balls of radius r at distance d share.
double lens(double r, double d) {
  return std::numbers::pi * (4 * r + d) * (2 * r - d) * (2 * r - d) / 12;
}

/// The joint measured on tetrahedra that are labelled like it, cube by cube.
CompileReport measured(const BallsJoint& joint) {
  const auto space = make_labelled_space(joint.file, joint.surfaces, {});
  if (!space) throw std::runtime_error(space.error().to_string());
  TetMesh mesh = test::make_body_of_tets(30, 60 * kMm, [&](const Vec3& p) {
    return std::max(kFirstRegion, space->labels.at(p - Vec3::Constant(30 * kMm)));
  });
  for (Vec3& p : mesh.vertices) p -= Vec3::Constant(30 * kMm);
  CompileReport report = joint.empty_report();
  measure_joint(mesh, space->labels, joint.surfaces, report);
  append_warnings(joint.file, space->labels, joint.surfaces, report);
  return report;
}

TEST(MeasureJoint, VolumesAreThoseOfBallsLessTheLensThatTheFirstTakes) {
  const CompileReport report = measured(make_joint());
  const double whole = ball_volume(10 * kMm);
  const StructureReport& a = report.structures[1];
  const StructureReport& b = report.structures[2];
  EXPECT_NEAR(a.region_volume, whole, 0.01 * whole);
  EXPECT_NEAR(a.lost_volume, 0, 0.002 * whole);
  EXPECT_NEAR(b.region_volume, whole, 0.01 * whole);
  EXPECT_NEAR(b.lost_volume, lens(10 * kMm, 12 * kMm), 0.01 * whole);
  EXPECT_NEAR(a.resolved_volume, whole, 0.05 * whole) << "cells of 2 mm";
  EXPECT_NEAR(b.resolved_volume, whole - lens(10 * kMm, 12 * kMm), 0.05 * whole);
}

TEST(MeasureJoint, ASurfaceThatIsThereAlreadyLosesAllAndOneThatIsALittleLargerAThinShell) {
  const BallsJoint joint{30 * kMm,
                         {{"first", "muscle", Vec3(0, 0, 0), 10 * kMm},
                          {"same", "muscle", Vec3(0, 0, 0), 10 * kMm},
                          {"larger", "muscle", Vec3(0, 0, 0), 10.2 * kMm}}};
  const CompileReport report = measured(joint);
  const double whole = ball_volume(10 * kMm);
  EXPECT_NEAR(report.structures[2].lost_volume, report.structures[2].region_volume, 0.002 * whole);
  const double shell = ball_volume(10.2 * kMm) - whole;
  EXPECT_NEAR(report.structures[3].region_volume - report.structures[3].lost_volume, shell,
              0.6 * shell)
      << "thinner than a sample is wide";
}

TEST(MeasureJoint, CountsWhatThereIsAndMeasuresHowFarInterfacesLieFromTheirSurface) {
  const CompileReport report = measured(make_joint());
  std::size_t tetrahedra = 0;
  for (const StructureReport& s : report.structures) tetrahedra += s.tetrahedra;
  EXPECT_EQ(tetrahedra, report.tetrahedra);
  EXPECT_EQ(report.tetrahedra, 6U * 30 * 30 * 30);
  EXPECT_EQ(report.structures[1].parts, 1U);
  EXPECT_GT(report.interfaces, 0U);
  EXPECT_EQ(report.quality.inverted, 0U);
  const DistanceStatistics& d = report.structures[1].distance;
  EXPECT_GT(d.mean, 0.1 * kMm) << "steps of a cube of cells";
  EXPECT_LT(d.mean, 1 * kMm);
  EXPECT_LT(d.mean, d.percentile95);
  EXPECT_LE(d.percentile95, d.max);
  EXPECT_LT(d.max, 2.1 * kMm) << "less than a cell";
}

bool warns(const StructureReport& report, const std::string& words) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

TEST(AppendWarnings, NamesWhatSticksOutAndOnlyThat) {
  const CompileReport report = measured(make_joint());
  EXPECT_FALSE(warns(report.structures[1], "outside the body"));
  EXPECT_TRUE(warns(report.structures[3], "outside the body"));
}

TEST(AppendWarnings, NamesWhatLosesMuchAndWhatIsLostWholly) {
  const CompileReport report =
      measured(BallsJoint(30 * kMm, {{"a", "muscle", Vec3::Zero(), 12 * kMm},
                                     {"half", "muscle", Vec3(9 * kMm, 0, 0), 10 * kMm},
                                     {"gone", "muscle", Vec3::Zero(), 8 * kMm}}));
  EXPECT_TRUE(warns(report.structures[2], "goes to structures before it"));
  EXPECT_TRUE(warns(report.structures[3], "none of it is in the joint"));
  EXPECT_FALSE(warns(report.structures[1], "goes to structures before it"));
}

TEST(AppendWarnings, AConstructOfNothingSaysWhatItIsMadeFrom) {
  BallsJoint joint(30 * kMm, {{"a", "muscle", Vec3::Zero(), 12 * kMm},
                              {"gone", "muscle", Vec3::Zero(), 8 * kMm}});
  joint.add_construct("lining", ShellConstruct{"gone", 1 * kMm});
  EXPECT_TRUE(warns(measured(joint).structures[3], "made from 'gone', of which there is none"));
}

TEST(CompileReport, ErrorOfAVolumeIsRelativeToWhatIsLeftOfIt) {
  StructureReport s;
  EXPECT_EQ(s.volume_error(), 0) << "nothing was expected";
  s.region_volume = 10;
  s.lost_volume = 2;
  s.resolved_volume = 9;
  EXPECT_DOUBLE_EQ(s.volume_error(), 0.125);
}

TEST(CompileReport, JsonHasTheUnitsItsKeysSay) {
  CompileReport report;
  report.structures.resize(2);
  report.structures[0].name = "a";
  report.structures[0].surface_volume = 2e-6;  // m^3
  report.structures[0].distance.max = 1e-3;    // m
  report.structures[1].refused = "a reason";
  report.steps.push_back({"meshing", 1.5});
  report.peak_memory = 3e6;
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_DOUBLE_EQ(json["structures"][0]["surface_volume_cm3"].get<double>(), 2);
  EXPECT_DOUBLE_EQ(json["structures"][0]["distance"]["max_mm"].get<double>(), 1);
  EXPECT_EQ(json["structures"][1]["refused"], "a reason");
  EXPECT_FALSE(json["structures"][1].contains("surface_volume_cm3"));
  EXPECT_DOUBLE_EQ(json["stages_s"]["meshing"].get<double>(), 1.5);
  EXPECT_DOUBLE_EQ(json["peak_memory_mb"].get<double>(), 3);
}

}  // namespace
}  // namespace artus
