// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/needle_tick_step.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "artus/haptics/needle_renderer.h"
#include "tests/support/layered_body.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

/// Tissue below z = 0; it can keep from its caller what it should say.
struct HalfSpace {
  bool truncated = false;
  QueryCount find_intervals(const Segment& segment, std::span<TissueInterval> out) const noexcept {
    const double length = (segment.end - segment.start).norm();
    const double skin = std::clamp(-segment.start.z(), 0.0, length);
    QueryCount count;
    if (skin > 0) out[count.size++] = {0, skin, kOutside, Vec3::Zero(), kNoInterface};
    if (skin < length) out[count.size++] = {skin, length, kTissue, -Vec3::UnitZ(), 0};
    if (truncated) count = {1, true};
    return count;
  }
  static constexpr RegionId kTissue = kFirstRegion;
};

class Insertion {
 public:
  Insertion() : tick_(table(), params()) {}
  const RenderedNeedle& step() {
    body.truncated = truncated;
    const double z = -5e-3 + 0.02 * time_;
    const TimedPose pose{make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX()), time_};
    time_ += tick_.period();
    return tick_.step(pose, body);
  }
  double force_after(int ticks) {
    double force = 0;
    for (int i = 0; i < ticks; ++i) force = -step().command.force.z();
    return force;
  }
  [[nodiscard]] const NeedleContact& contact() const { return tick_.model().contact(); }

  HalfSpace body;
  bool truncated = false;

 private:
  static LayerTable table() {
    LayerHaptics layer;
    layer.tissue.cutting_force = 2;
    layer.tissue.wall_stiffness = 2000;
    return LayerTable({{}, {}, layer});
  }
  static NeedleRendererParams params() {
    NeedleRendererParams params;
    params.device = find_device("ideal").value();
    return params;
  }
  NeedleTickStep tick_;
  double time_ = 0;
};

TEST(NeedleTickStep, ATruncatedQueryFadesTheForceAndAWholeOneBringsItBack) {
  Insertion needle;
  ASSERT_NEAR(needle.force_after(600), 2, 1e-9);
  needle.truncated = true;
  const double step = 2 * 1e-3 / GuardParams{}.ramp_time;
  double before = 2;
  for (int i = 1; i <= 50; ++i) {
    const RenderedNeedle& out = needle.step();
    const double force = -out.command.force.z();
    EXPECT_NEAR(before - force, step, 1e-9) << "no jump, and on its way to zero";
    EXPECT_NE(out.status & TickStatus::kTruncated, 0U);
    EXPECT_EQ(out.status & TickStatus::kFaults, 0U);
    EXPECT_EQ(needle.contact().events(), 0U);
    before = force;
  }
  needle.truncated = false;
  const RenderedNeedle& back = needle.step();
  EXPECT_EQ(back.status & TickStatus::kTruncated, 0U);
  EXPECT_NEAR(-back.command.force.z(), before + step, 1e-9);
  EXPECT_NEAR(needle.force_after(60), 2, 1e-9);
}

TEST(NeedleTickStep, AQueryThatStaysTruncatedEndsAtZeroAndTheNeedleThenBeginsAtRest) {
  Insertion needle;
  needle.force_after(600);
  needle.truncated = true;
  needle.force_after(201);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(needle.step().command.force.norm(), 0);
  needle.truncated = false;
  needle.step();
  EXPECT_NE(needle.contact().events() & ContactEvent::kAdopted, 0U);
  EXPECT_NEAR(needle.force_after(300), 2, 1e-9);
}

TEST(NeedleTickStep, NeitherAllocatesNorLocksWhateverTheBodySays) {
  NeedleRendererParams params;
  params.device = find_device("ideal").value();
  NeedleTickStep tick(LayerTable({{}, {}, {}}), params);
  HalfSpace body;
  for (int i = 0; i < 1000; ++i) {
    const double t = 1e-3 * i;
    body.truncated = i % 100 < 5;
    const TimedPose pose{make_pose(Vec3(0, 0, 0.02 * t - 5e-3), Vec3::UnitZ(), Vec3::UnitX()), t};
    ARTUS_RUNS_REALTIME(NeedleTickStep::step, test::use(tick.step(pose, body)));
  }
}

TEST(NeedleTickStep, ABodyOfMoreLayersThanALineHoldsGivesNoForceAndSaysSo) {
  std::vector<test::FlatLayer> layers;
  for (int i = 0; i < 80; ++i) layers.push_back({i % 2 == 0 ? "muscle" : "fat", 0.2e-3});
  const auto scene = std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 0.1, 0.1)));
  const auto needle = make_needle_renderer(scene, "ideal", 1000).value();
  std::uint32_t status = 0;
  for (int i = 0; i < 1000; ++i) {
    const double t = 1e-3 * i;
    const RenderedNeedle& out =
        needle->step({make_pose(Vec3(0, 0, 0.02 * t - 5e-3), Vec3::UnitZ(), Vec3::UnitX()), t});
    status |= out.status;
    ASSERT_TRUE(out.command.force.allFinite());
    if (i > 400) {
      ASSERT_EQ(out.command.force.norm(), 0) << i;
    }
  }
  EXPECT_NE(status & TickStatus::kTruncated, 0U);
}

}  // namespace
}  // namespace artus
