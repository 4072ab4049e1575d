// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/attempt_meter.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "artus/detail/training/metrics/attempt_metrics.h"
#include "tests/session/session_support.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

Goals tendon_goals(const CompiledJoint& joint) {
  Goals goals;
  goals.target =
      Target{"bursa", std::nullopt, make_region_body(joint, region_named(joint, "bursa"))};
  goals.avoid.push_back(
      {"tendon", make_region_body(joint, region_named(joint, "tendon")), 0, true});
  goals.entry = Vec3(-17e-3, 4e-3, 0);
  return goals;
}

/// Down to `depth` at 10 mm/s, a rest, and out; `off`: the probe's plane beside the needle's.
AttemptMeasures insert(double depth, double off) {
  const auto scene = test::make_layered_scene();
  MeterOptions options;
  options.goals = tendon_goals(scene->joint());
  AttemptMeter meter(scene, options);
  const Vec3 axis = Vec3(0.8, 0, 0.6);
  const Vec3 entry(-20e-3, 0, 0);
  const Eigen::Quaterniond needle(make_pose(Vec3::Zero(), axis, Vec3::UnitY()).linear());
  const auto place = [&](double t, double distance) {
    meter.add_needle(t, entry + distance * axis, needle);
    meter.add_probe(t, Vec3(0, off, 0), Eigen::Quaterniond(1, 0, 0, 0));
  };
  const double end = depth / 10e-3 + 0.5;
  double t = 0;
  for (; t < end; t += 1e-3) place(t, 10e-3 * (t - 0.5));
  for (; t < end + 1; t += 1e-3) place(t, depth);
  for (; t < 2 * end + 1; t += 1e-3) place(t, depth - 20e-3 * (t - end - 1));
  return meter.measure();
}

double value(const AttemptMeasures& m, const std::string& name) {
  const Metric* metric = find_metric(m.metrics, name);
  EXPECT_NE(metric, nullptr) << name;
  return metric != nullptr ? metric->value.value_or(NAN) : NAN;
}

TEST(AttemptMeter, AnInsertionInPlaneIsSeenAllTheWay) {
  const AttemptMeasures m = insert(38e-3, 0);
  EXPECT_EQ(value(m, "in_plane_fraction"), 1);
  EXPECT_EQ(value(m, "unseen_advances"), 0);
  EXPECT_EQ(value(m, "passes"), 1);
  EXPECT_NEAR(value(m, "deepest_mm"), 38, 0.1);
  EXPECT_NEAR(value(m, "distance_mm"), 0, 1e-6);
  EXPECT_EQ(value(m, "avoid_fatal"), 0);
  EXPECT_NEAR(value(m, "swept_area_mm2"), 0, 0.01);
  EXPECT_NEAR(value(m, "face_angle_median_deg"), std::asin(0.6) * 57.29578, 0.01);
}

TEST(AttemptMeter, TheEntryIsHeldAgainstTheOneAskedFor) {
  const AttemptMeasures m = insert(38e-3, 0);
  EXPECT_NEAR(value(m, "entry_offset_mm"), 5, 1e-3);
  EXPECT_NEAR(value(m, "entry_angle_deg"), std::asin(0.6) * 57.29578, 0.01);
  const AttemptMeasures never = insert(-1e-3, 0);
  const Metric* offset = find_metric(never.metrics, "entry_offset_mm");
  ASSERT_NE(offset, nullptr);
  EXPECT_FALSE(offset->value);
}

TEST(AttemptMeter, BesideThePlaneTheAdvanceIsUnseenAndSaysWhy) {
  const AttemptMeasures m = insert(38e-3, 4e-3);
  EXPECT_EQ(value(m, "in_plane_fraction"), 0);
  EXPECT_EQ(value(m, "unseen_advances"), 8);  // 1 and each 5 mm more
  EXPECT_NEAR(value(m, "unseen_mm"), 38, 0.6);
  EXPECT_NEAR(value(m, "plane_offset_median_mm"), 4, 1e-3);
  bool told = false;
  for (const AttemptEvent& e : m.events)
    told =
        told || (e.kind == "unseen" && e.text.find("4.0 mm behind the plane") != std::string::npos);
  EXPECT_TRUE(told);
}

TEST(AttemptMeter, TooDeepGoesIntoTheZone) {
  const AttemptMeasures m = insert(42e-3, 0);
  EXPECT_EQ(value(m, "avoid_fatal"), 1);
  EXPECT_NEAR(value(m, "avoid_depth_mm"), 42 * 0.6 - 24, 0.05);
  EXPECT_NEAR(value(m, "distance_mm"), 42 * 0.6 - 24, 0.05);
}

TEST(AttemptMeter, NoNumberDependsOnHowStreamsAreInterleaved) {
  const auto scene = test::make_layered_scene();
  AttemptMeter together(scene, {});
  AttemptMeter apart(scene, {});
  const auto needle = [](AttemptMeter& m, int i) {
    m.add_needle(1e-3 * i, Vec3(0, 0, 5e-6 * i), Eigen::Quaterniond(1, 0, 0, 0));
  };
  const auto probe = [](AttemptMeter& m, int i) {
    m.add_probe(1e-3 * i, Vec3(1e-7 * i, 0, 0), Eigen::Quaterniond(1, 0, 0, 0));
  };
  for (int i = 0; i < 3000; ++i) {
    needle(together, i);
    probe(together, i);
  }
  for (int i = 0; i < 3000; ++i) needle(apart, i);
  for (int i = 0; i < 3000; ++i) probe(apart, i);
  EXPECT_EQ(to_json(together.measure().metrics).dump(), to_json(apart.measure().metrics).dump());
}

TEST(AttemptMeter, TakesPosesAndForcesInTheTick) {
  AttemptMeter meter(test::make_layered_scene(), {});
  const Eigen::Quaterniond q(1, 0, 0, 0);
  ARTUS_RUNS_REALTIME(AttemptMeter::add_needle, meter.add_needle(1, Vec3::Zero(), q));
  ARTUS_RUNS_REALTIME(AttemptMeter::add_probe, meter.add_probe(1, Vec3::Zero(), q));
  ARTUS_RUNS_REALTIME(AttemptMeter::add_felt, meter.add_felt({}));
  ARTUS_RUNS_REALTIME(AttemptMeter::add_syringe, meter.add_syringe({}));
}

TEST(AttemptMeter, WithoutPosesNothingIsClaimed) {
  const AttemptMeter meter(test::make_layered_scene(), {});
  for (const Metric& m : meter.measure().metrics)
    if (m.unit == "mm" && m.name.rfind("path_length", 0) == 0) {
      EXPECT_FALSE(m.value) << m.name;
    }
}

TEST(AttemptMeter, EveryMetricHasItsDefinitionAndRule) {
  for (const Metric& m : insert(20e-3, 0).metrics) {
    EXPECT_FALSE(m.definition.empty()) << m.name;
    EXPECT_FALSE(m.rule.filter.empty()) << m.name;
    EXPECT_FALSE(m.unit.empty()) << m.name;
  }
  const auto names = metric_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const char* name : {"distance_mm", "avoid_fatal", "tip_visible", "bone_contacts", "sparc"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST(Metric, TablesReadBackToTheSameBits) {
  const std::vector<Metric> metrics{{"a", "needle", "mm", 1.0 / 3, "say \"x\", y", {"none", 0}},
                                    {"b", "probe", "-", std::nullopt, "z", {"none", 20}}};
  const auto back = metrics_from_json(nlohmann::json::parse(to_json(metrics).dump()));
  EXPECT_EQ(*back[0].value, 1.0 / 3);
  EXPECT_FALSE(back[1].value);
  EXPECT_EQ(to_tsv(metrics),
            "MetricName\tMetricRoles\tMetricUnit\tMetricValue\na\tneedle\tmm\t"
            "0.33333333333333331\n");
  EXPECT_NE(to_csv(metrics).find("\"say \"\"x\"\", y\""), std::string::npos);
}

}  // namespace
}  // namespace artus
