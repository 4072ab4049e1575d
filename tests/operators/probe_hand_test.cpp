// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/probe_hand.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/echo/renderer.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

const std::array<test::FlatLayer, 4> kLayers{
    {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 14e-3}, {"bone", 20e-3}}};

std::shared_ptr<const Scene> block() {
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_layered_block(kLayers, 0.12, 0.12)));
}

Pose on_top(double x = 0, double tilt = 0, double depth = 0) {
  Pose pose = make_pose(Vec3(x, 0, depth), Vec3::UnitZ(), Vec3::UnitX());
  pose.rotate(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  return pose;
}

/// Leans for a second, slides 10 mm along x in the next, holds for one more.
ProbeHandRow press_and_slide(RigidProbeHand& hand, std::vector<ProbeHandRow>* rows = nullptr) {
  ProbeHandRow row;
  for (int i = 0; i < 3000; ++i) {
    row = hand.step([](double t) {
      ProbeIntention wanted;
      wanted.X_JP = on_top(0.010 * std::clamp(t - 1, 0.0, 1.0));
      wanted.lift = t < 0.1 ? 1 : 0;
      return wanted;
    });
    if (rows != nullptr) rows->push_back(row);
  }
  return row;
}

TEST(ProbeHand, LeansWithTheWantedForceWhateverIsBelow) {
  for (const double force : {1.0, 3.0, 8.0}) {
    ProbeHandParams params;
    params.press_force = force;
    RigidProbeHand hand(block(), params, 1000, on_top());
    const ProbeHandRow row = press_and_slide(hand);
    EXPECT_NEAR(row.normal_force, force, 0.02 * force);
    EXPECT_EQ(row.status, 0U);
    EXPECT_EQ(row.contact_share, 1);
  }
}

TEST(ProbeHand, SlidingDragsAgainstTheMotionAndCountsTheWay) {
  RigidProbeHand hand(block(), {}, 1000, on_top());
  std::vector<ProbeHandRow> rows;
  const ProbeHandRow last = press_and_slide(hand, &rows);
  const ProbeHandRow& sliding = rows[1500];
  const double coulomb = ProbeContactParams{}.gel_friction * sliding.normal_force;
  EXPECT_NEAR(sliding.friction.norm(), coulomb, 0.05 * coulomb);
  EXPECT_LT(sliding.friction.x(), -0.9 * coulomb);
  // The skin comes along for Coulomb's force over its shear stiffness, then the face slips.
  EXPECT_NEAR(last.slip, 0.010, 0.5e-3);
  EXPECT_LE(last.energy_to_hand, 0);
  EXPECT_EQ(rows.front().normal_force, 0);
}

TEST(ProbeHand, SameSeedGivesTheSameRows) {
  RigidProbeHand a(block(), {}, 1000, on_top());
  RigidProbeHand b(block(), {}, 1000, on_top());
  const ProbeHandRow last_a = press_and_slide(a);
  const ProbeHandRow last_b = press_and_slide(b);
  EXPECT_EQ(last_a.X_JP.matrix(), last_b.X_JP.matrix());
  EXPECT_EQ(last_a.normal_force, last_b.normal_force);
}

TEST(ProbeHand, ElementsThatLiftAreBlackInThePicture) {
  // Tilted by 8 degrees, the face leaves the skin (and the gel) on its +x side.
  const auto scene = block();
  ProbeContactParams params;
  ProbeContactModel contact(scene, params);
  static_cast<void>(contact.step(on_top(0, 8 * kDegree, 0.5e-3)));
  ImageSettings raw;
  raw.look = Look::raw;
  Renderer renderer(scene, Transducer{}, raw);
  renderer.set_contact(contact.coverage());
  const Frame& frame = renderer.render(on_top(0, 8 * kDegree, 0.5e-3));
  const auto n = static_cast<std::size_t>(frame.n_samples);
  const auto strongest = [&](std::size_t line, double from, double to) {
    const float* data = &frame.decibel[line * n];
    return *std::max_element(data + static_cast<std::size_t>(from / frame.sample_depth),
                             data + static_cast<std::size_t>(to / frame.sample_depth));
  };
  const auto coverage = contact.coverage();
  std::size_t lifted = 0;
  for (std::size_t l = 8; l + 8 < static_cast<std::size_t>(frame.n_lines); ++l) {
    const std::size_t e = l * coverage.size() / static_cast<std::size_t>(frame.n_lines);
    const bool all_on = *std::min_element(&coverage[e - 4], &coverage[e + 4]) == 1;
    const bool all_off = *std::max_element(&coverage[e - 4], &coverage[e + 4]) == 0;
    // The skin's and fat's echoes within the first millimetres, below the lens's ringing.
    if (all_on) {
      EXPECT_GT(strongest(l, 2e-3, 4e-3), -60) << l;
    }
    if (!all_off) continue;
    ++lifted;
    EXPECT_GT(strongest(l, 0, 1e-3), -20) << l;  // rings at the top
  }
  EXPECT_GT(lifted, static_cast<std::size_t>(frame.n_lines) / 5);
  // The first lifted line far from the edge of contact hears nothing at all below.
  const std::size_t far = static_cast<std::size_t>(frame.n_lines) - 4;
  EXPECT_LT(strongest(far, 12e-3, 14e-3), -50);
}

}  // namespace
}  // namespace artus
