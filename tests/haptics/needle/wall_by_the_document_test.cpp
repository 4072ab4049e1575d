// SPDX-License-Identifier: AGPL-3.0-or-later
// The engine's wall beside a reader's.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/haptics/needle/laws/tracking_wall.h"
#include "tests/haptics/needle/document_wall.h"
#include "tests/haptics/needle/tick_builder.h"

namespace artus {
namespace {

using test::DocumentLayer;
using test::DocumentTick;
using test::DocumentWall;

DocumentLayer layer_at(double x) {
  if (x < 2e-3) return {1, 0.3, 1500};
  if (x < 6e-3) return {2, 0.5, 500};
  if (x < 9e-3) return {1.5, 0.4, 700};
  return {2.5, 0.6, 500};
}

// Random walks from the skin over layers that change force and stiffness, with rests, bone that
// comes and goes, and lines that move.
TEST(WallByTheDocument, IsTheEnginesOverRandomHistories) {
  double largest = 0;
  int on_bone = 0;
  int bounded = 0;
  for (std::uint64_t history = 0; history < 2000; ++history) {
    const double dt = history % 3 == 0 ? 1e-3 : history % 3 == 1 ? 2e-4 : 1e-4;
    test::AxialTick line(test::soft(1), dt);
    TrackingWall wall;
    DocumentWall reader;
    const double w0 = -1e-3 * uniform_noise(history, 0);
    wall.start(w0, 0);
    reader.begin(w0, 0);
    double x = 0;
    double goal = 0;
    double still = 0;
    for (std::uint64_t i = 1; i < 1500; ++i) {
      const auto noise = [&](std::uint64_t k) {
        return uniform_noise(history + 10000 * k, i);
      };
      if (i % 50 == 1) {
        goal = 14e-3 * noise(1) - 1e-3;
        still = noise(2) < 0.3 ? 1 : noise(2) < 0.5 ? noise(3) : 0;
      }
      const double most = 0.1 * dt * noise(4);
      x = still == 1 ? x : std::abs(goal - x) < most ? goal : x + std::copysign(most, goal - x);
      DocumentTick t{dt, x, still, layer_at(x), 12e-3, 4, 4000};
      t.bone_depth = noise(5) < 0.9 ? 10e-3 : std::numeric_limits<double>::infinity();
      if (i % 97 == 0) {
        t.gain = 1e-4 * (noise(6) - 0.5);
        t.kept = noise(7);
        x += t.gain;
        t.x = x;
        wall.take_line(t.gain, t.kept);
      }
      NeedleTick& tick = line.at(x);
      tick.stillness = still;
      tick.layer.tissue = test::soft(t.layer.f_r, t.layer.k_t, t.layer.f_a);
      tick.bone.tissue = test::soft(t.bone_f, t.bone_k, 0);
      tick.bone_depth = t.bone_depth;
      const double engine = wall.step(tick).force.z();
      const double document = reader.step(t);
      ASSERT_NEAR(engine, document, 1e-9) << "history " << history << " tick " << i;
      largest = std::max(largest, std::abs(engine));
      on_bone += x > t.bone_depth ? 1 : 0;
      bounded += wall.absorbed() <= 0 ? 1 : 0;
    }
  }
  EXPECT_GT(largest, 3.9) << "bone on top of the soft force was felt";
  EXPECT_GT(on_bone, 1000);
  EXPECT_GT(bounded, 1000) << "the account was empty often enough to bound the force";
}

}  // namespace
}  // namespace artus
