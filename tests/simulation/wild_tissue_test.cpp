// SPDX-License-Identifier: AGPL-3.0-or-later
// The whole of a session that hands feel, without its threads: the needle's tick, the solver it
// loads, the probe that presses, a device that breaks.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/simulation/tissue_core.h"
#include "artus/haptics/needle_renderer.h"
#include "tests/support/broken_device.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

constexpr double kTick = 1e-3;             // s
constexpr std::uint64_t kImageTicks = 33;  // from one step of the tissue to the next
constexpr std::uint64_t kSeed = 417;

/// A hundredth of a million as shipped; ARTUS_WILD_TICKS says how many.
std::uint64_t ticks() {
  const char* wanted = std::getenv("ARTUS_WILD_TICKS");
  return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 10'000;
}

double random(std::uint64_t what, std::uint64_t i) {
  return uniform_noise(kSeed + what, i);
}

/// Presses from 4 mm above the skin to 8 mm into it, slides, tilts, and jumps from one to another
/// six times a second; leaves the skin in every fourth of its moves.
Pose wild_probe(const Pose& X_JP, std::uint64_t image) {
  const std::uint64_t move = image / 5;
  Pose pose = X_JP;
  const double depth = move % 4 == 3 ? -10e-3 : -4e-3 + 12e-3 * random(1, move);
  pose.translate(Vec3(6e-3 * (random(2, move) - 0.5), 6e-3 * (random(3, move) - 0.5), depth));
  pose.rotate(Eigen::AngleAxisd(0.3 * (random(4, move) - 0.5), Vec3::UnitX()));
  pose.rotate(Eigen::AngleAxisd(0.3 * (random(5, move) - 0.5), Vec3::UnitZ()));
  return pose;
}

/// A needle beside the probe: in and out by 20 mm, trembling, turned to and fro, twisted in the
/// tissue, and thrown to another place every 4 s.
Pose wild_needle(const Pose& X_JP, std::uint64_t tick) {
  const double t = kTick * static_cast<double>(tick);
  const std::uint64_t stroke = tick / 4000;
  const double jump = tick % 500 < 3 ? 2e-3 * (random(6, tick / 500) - 0.5) : 0;
  const double depth = 16e-3 * (1 - std::cos(2 * t * (1 + random(7, stroke)))) - 8e-3 + jump +
                       1e-4 * std::sin(60 * t);
  const double turn = 0.06 * std::sin(3 * t);
  Pose pose = X_JP;
  pose.translate(Vec3(10e-3 * (random(8, stroke) - 0.5), 11e-3, 0));
  pose.rotate(Eigen::AngleAxisd(turn, Vec3::UnitY()));
  pose.rotate(Eigen::AngleAxisd(3 * std::sin(2 * t), Vec3::UnitZ()));
  pose.translate(Vec3(0, 0, depth));
  return pose;
}

struct Whole {
  std::shared_ptr<const CompiledJoint> joint;
  NeedleRendererParams params;
  std::unique_ptr<TissueCore> core;
  std::unique_ptr<NeedleRenderer> needle;

  Whole() {
    const std::array<FlatLayer, 4> layers{
        {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
    CompiledJoint block = test::make_meshed_block(layers, 0.096, 0.064, 4e-3);
    for (Tissue& tissue : block.tissues) {
      if (!tissue.haptic.hard) tissue.haptic.puncture_force = tissue.name == "skin" ? 1.5 : 0;
    }
    joint = std::make_shared<const CompiledJoint>(std::move(block));
    params.device = find_device("virtuose_6d_desktop").value();
    params.rate_hz = 1 / kTick;
    params.guard.workspace_half = Vec3::Constant(0.25);
    auto made = TissueCore::make(joint, joint->X_JP_default, 1 / (kTick * kImageTicks));
    core = std::make_unique<TissueCore>(std::move(made.value()));
    const auto scene = std::make_shared<const Scene>(joint);
    needle = std::make_unique<NeedleRenderer>(scene, make_layer_table(scene->joint()), params);
  }
  [[nodiscard]] const NeedleCoupling& coupling() const { return needle->model().coupling(); }
  void step_tissue(const std::optional<Pose>& X_JP, const Pose& X_JN) {
    core->step(X_JP, NeedleGrip{X_JN, coupling().cube_load()});
    needle->take(core->packet().needle);
  }
  /// m
  [[nodiscard]] double moved() const {
    double most = 0;
    for (const Vec3& u : core->scene()->tissue()->node_displacements())
      most = u.allFinite() ? std::max(most, u.norm()) : INFINITY;
    return most;
  }
};

TEST(WildTissue, StaysFiniteWithinLimitsAndMeteredAndComesBackToRest) {
  Whole whole;
  const Pose X_JP = whole.joint->X_JP_default;
  const std::uint64_t n = ticks();
  std::uint64_t felt = 0;
  std::uint64_t tented = 0;
  double max_moved = 0;
  double max_given = -INFINITY;  // J to the hand beyond what is metered
  std::uint64_t faults = 0;
  test::Bursts bursts{kSeed};
  TimedPose before;                        // the last without a fault
  Pose X_JN_image = wild_needle(X_JP, 0);  // the last that was not refused
  for (std::uint64_t i = 0; i < n; ++i) {
    const test::Fault fault = bursts.at(i);
    const TimedPose sane{wild_needle(X_JP, i), kTick * static_cast<double>(i)};
    if (!bursts.faulty) before = sane;
    if (i % kImageTicks == 0) {
      whole.step_tissue(wild_probe(X_JP, i / kImageTicks), X_JN_image);
      const double moved = whole.moved();
      ASSERT_LT(moved, 30e-3) << i;
      max_moved = std::max(max_moved, moved);
      ASSERT_TRUE(is_packet(whole.core->packet().probe)) << i;
    }
    const TimedPose sent = test::broken(fault, kSeed, i, sane, before);
    const RenderedNeedle& out = whole.needle->step(sent);
    ASSERT_TRUE(out.command.force.allFinite() && out.command.torque.allFinite()) << i;
    if ((out.status & TickStatus::kFaults) == 0) {
      X_JN_image = sent.X_JN;
    } else {
      ASSERT_EQ(out.command.force.norm() + out.command.torque.norm(), 0) << i;
      ++faults;
    }
    ASSERT_LE(out.command.force.norm(), whole.params.device.force * (1 + 1e-9)) << i;
    ASSERT_LE(out.command.torque.norm(), whole.params.device.torque * (1 + 1e-9)) << i;
    ASSERT_TRUE(std::isfinite(whole.coupling().stored() + whole.coupling().dissipated())) << i;
    max_given = std::max(max_given, out.energy_to_hand - whole.coupling().given());
    felt += out.command.force.norm() > 0.3 ? 1 : 0;
    tented += whole.coupling().tip_displacement() > 1e-4 ? 1 : 0;
  }
  EXPECT_GT(felt, n / 10);
  EXPECT_GT(tented, n / 20);
  EXPECT_GT(faults, n / 200);
  EXPECT_GT(max_moved, 5e-3) << "the probe pressed";
  EXPECT_LE(max_given, 1e-6);
  RecordProperty("max_moved_um", static_cast<int>(1e6 * max_moved));
  Pose away = X_JP;
  away.translate(Vec3(0, 0, -40e-3));
  for (std::uint64_t i = n; i < n + 4000; ++i) {
    if (i % kImageTicks == 0) whole.step_tissue(std::nullopt, away);
    static_cast<void>(whole.needle->step({away, kTick * static_cast<double>(i)}));
  }
  EXPECT_LT(whole.moved(), 1e-7);
  EXPECT_LT(std::abs(whole.coupling().tip_displacement()), 1e-7);
  EXPECT_EQ(whole.coupling().stored(), 0);
  const RenderedNeedle& last = whole.needle->step({away, kTick * static_cast<double>(n + 4000)});
  EXPECT_EQ(last.command.force.norm(), 0);
}

}  // namespace
}  // namespace artus
