// SPDX-License-Identifier: AGPL-3.0-or-later
// The line that moves gives the hand no energy: at no instant of a way that sways and goes in and
// out has the force to the line worked more for the hand than against it.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/evidence/validation/needle/sway.h"

namespace artus {
namespace {

/// In within a second from outside; then the depth swings twice as often as the tip goes aside,
/// which is how a lateral spring that stiffens with depth would be pumped.
struct Swing {
  double depth = 0;  // m, around which
  double swing = 0;  // m
  double aside = 0;  // m
  double hz = 0;     // of the tip aside
  bool pivots = false;
};

Pose pose_at(const Swing& path, double phase, double t) {
  constexpr double kOutside = -0.002;  // m
  const double turned = kTwoPi * path.hz * t;
  const double share = std::min(1.0, t);
  const double deep = path.depth + path.swing * std::sin(2 * turned + phase);
  const double z = kOutside + share * (deep - kOutside);
  const double aside = share * path.aside * std::sin(turned);
  if (!path.pivots) return make_pose(Vec3(aside, 0, z), Vec3::UnitZ(), Vec3::UnitY());
  const Vec3 axis = Vec3(aside, 0, path.depth).normalized();
  return make_pose(z * axis, axis, Vec3::UnitY());
}

// The most that the force to the line has given until any instant, J: by the mean of the forces at
// both ends of a tick, so that what a held force gives by itself does not count.
double max_given(const Swing& path, double phase, int rate, double* exchanged) {
  constexpr double kDuration = 3;  // s
  const LayerTable table = test::sway_layers(false);
  const AnalyticBody body =
      AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, 0.0041, 0.018, 0.021});
  NeedleModel model(NeedleParams{}, table, 1.0 / rate);
  std::array<TissueInterval, 64> buffer{};
  Vec3 tip = pose_at(path, phase, 0).translation();
  Vec3 force = Vec3::Zero();
  double given = 0;
  double most = 0;
  for (int i = 0; i <= static_cast<int>(kDuration * rate); ++i) {
    const Pose X_JN = pose_at(path, phase, static_cast<double>(i) / rate);
    const QueryCount met = body.find_intervals(model.query_segment(X_JN), buffer);
    model.step(X_JN, std::span<const TissueInterval>(buffer.data(), met.size));
    const Vec3 now = model.forces().clamping;
    const double work = 0.5 * (force + now).dot(X_JN.translation() - tip);
    given += work;
    *exchanged += std::abs(work);
    most = std::max(most, given);
    tip = X_JN.translation();
    force = now;
  }
  return most;
}

TEST(SwayEnergy, TheMovingLineHasGivenTheHandNothingAtAnyInstant) {
  const Swing paths[] = {{0.015, 0.001, 1e-3, 4, false},    // held: a spring
                         {0.015, 0.001, 1e-3, 4, true},     //
                         {0.012, 0.008, 1.5e-3, 1, false},  // dragged
                         {0.012, 0.008, 1.5e-3, 1, true},   //
                         {0.004, 0.0045, 1e-3, 1, false},   // out of the skin and in again
                         {0.004, 0.0030, 1e-3, 1, true}};   // let go and held again
  constexpr double kNothing = 0.2e-6;                       // J
  for (std::size_t w = 0; w < std::size(paths); ++w) {
    double worst = 0;
    double exchanged = 0;
    constexpr int kRuns = 60;
    for (int p = 0; p < 20; ++p) {
      for (const int rate : {1000, 2000, 5000}) {
        const double given = max_given(paths[w], kTwoPi * p / 20, rate, &exchanged);
        EXPECT_LT(given, kNothing) << "path " << w << ", phase " << p << ", " << rate << " Hz";
        worst = std::max(worst, given);
      }
    }
    EXPECT_GT(exchanged / kRuns, 1e-4) << "J to and fro in a run";
    RecordProperty("max_given_" + std::to_string(w), std::to_string(1e6 * worst) + " uJ");
    RecordProperty("exchanged_" + std::to_string(w),
                   std::to_string(1e6 * exchanged / kRuns) + " uJ");
  }
}

}  // namespace
}  // namespace artus
