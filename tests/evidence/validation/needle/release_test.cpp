// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/needle/release.h"

#include <vector>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kDt = 1e-3;   // s
constexpr double kOpen = 0.1;  // s

DeviceLimits device_of(double mass, double damping) {
  DeviceLimits device;
  device.mass = mass;
  device.damping = damping;
  return device;
}

// A needle that coasts outwards from `speed` under the device's damping once it is let go, and is
// pushed out by `push` N of a force law from then on.
std::vector<NeedleRow> coast(const DeviceLimits& device, double speed, double push) {
  std::vector<NeedleRow> rows;
  double z = 0.025;
  double v = -speed;
  double energy = 0;
  for (int i = 0; i < 3000; ++i) {
    NeedleRow row;
    row.time = i * kDt;
    row.needle.X_JN.translation().z() = z;
    row.needle.velocity.z() = row.time < kOpen ? 0 : v;
    row.energy_to_hand = energy;
    if (row.time < kOpen) row.hand = Vec3(0, 0, 1);
    rows.push_back(row);
    if (row.time < kOpen) continue;
    const double before = z;
    constexpr int kSteps = 100;
    for (int k = 0; k < kSteps; ++k) {
      v += kDt / kSteps * (-device.damping * v - push) / device.mass;
      z += kDt / kSteps * v;
    }
    energy += -push * (z - before);
  }
  return rows;
}

TEST(Release, NeedleThatOnlyCoastsIsNotEjected) {
  const DeviceLimits device = device_of(0.2, 1);
  const auto rows = coast(device, 2e-3, 0);
  const Release r = measure_release(rows, kOpen, rows.back().time, device);
  EXPECT_NEAR(r.moved, 2e-3 * 0.2 / 1, 2e-6);  // v m / b
  EXPECT_NEAR(r.momentum, r.moved, 2e-6);
  EXPECT_NEAR(r.ejection(), 0, 2e-6);
}

TEST(Release, WhatAForcePushesOutIsEjection) {
  const DeviceLimits device = device_of(0.05, 2);
  const auto rows = coast(device, 0, 0.01);
  const Release r = measure_release(rows, kOpen, rows.back().time, device);
  // v = F / b once it moves: 5 mm/s for 2.9 s, less the start's m / b.
  EXPECT_NEAR(r.ejection(), 5e-3 * (2.9 - 0.025), 2e-4);
  EXPECT_NEAR(r.momentum, 0, 1e-9);
}

// The force law works while the fingers open: the speed it gives does not count as the hand's.
TEST(Release, SpeedThatTheLawGaveWhileTheFingersOpenedIsNotTheHands) {
  const DeviceLimits device = device_of(0.05, 1e-3);
  std::vector<NeedleRow> rows;
  double z = 0;
  double v = 0;
  double energy = 0;
  for (int i = 0; i < 400; ++i) {
    NeedleRow row;
    row.time = i * kDt;
    row.needle.X_JN.translation().z() = z;
    row.needle.velocity.z() = v;
    row.energy_to_hand = energy;
    if (i < 50) row.hand = Vec3(0, 0, 1e-12);
    rows.push_back(row);
    if (i >= 50) continue;
    const double next = v - 0.1 / 0.05 * kDt;  // 0.1 N outwards
    z += kDt * 0.5 * (v + next);
    energy += 0.1 * kDt * -0.5 * (v + next);
    v = next;
  }
  const Release r = measure_release(rows, 0, rows.back().time, device);
  EXPECT_NEAR(r.momentum, 0, 1e-6);
  EXPECT_NEAR(r.ejection(), 0.5 * 2 * 0.05 * 0.05, 1e-6);  // a t^2 / 2, and what follows is flat
}

}  // namespace
}  // namespace artus
