// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/needle/analytic_body.h"
#include "artus/detail/haptics/needle/needle_model.h"

namespace artus::test {

/// A needle that sways by 1 mm at 4 Hz, in, back and in again. Poses are of time alone, so that
/// each rate samples one path.
struct Sway {
  double back = 0;      // m, depth that the needle is drawn back to
  double phase = 0;     // rad
  bool pivots = false;  // about the entry; else the needle stays parallel to itself
  bool membranes = true;
  double first_border = 0.0041;  // m, where the second layer begins
};

/// In, a rest of 0.3 s, back, 50 ms, in again, a rest of 0.5 s.
class SwayPath {
 public:
  explicit SwayPath(double back) : back_(back) {
    constexpr double kStart = 0.1;  // s
    times_ = {kStart, kStart + (kDeep - kFrom) / kIn};
    times_.push_back(times_.back() + 0.3);
    times_.push_back(times_.back() + (kDeep - back) / kOut);
    times_.push_back(times_.back() + 0.05);
    times_.push_back(times_.back() + (kAgain - back) / kIn);
  }
  [[nodiscard]] double duration() const { return times_.back() + 0.5; }
  [[nodiscard]] double depth(double t) const {
    const std::array<double, 6> depths{kFrom, kDeep, kDeep, back_, back_, kAgain};
    if (t <= times_[0]) return depths[0];
    for (std::size_t i = 1; i < times_.size(); ++i) {
      if (t >= times_[i]) continue;
      const double share = (t - times_[i - 1]) / (times_[i] - times_[i - 1]);
      return depths[i - 1] + share * (depths[i] - depths[i - 1]);
    }
    return depths.back();
  }

  static constexpr double kFrom = -0.005;  // m
  static constexpr double kDeep = 0.025;   // m, first insertion
  static constexpr double kAgain = 0.022;  // m, second
  static constexpr double kIn = 0.015;     // m/s
  static constexpr double kOut = 0.020;    // m/s

 private:
  double back_;
  std::vector<double> times_;
};

inline Pose sway_pose(const SwayPath& path, const Sway& sway, double t) {
  const double z = path.depth(t);
  const double aside = 1e-3 * std::sin(kTwoPi * 4 * t + sway.phase);
  if (!sway.pivots) return make_pose(Vec3(aside, 0, z), Vec3::UnitZ(), Vec3::UnitY());
  const Vec3 axis = Vec3(aside, 0, SwayPath::kDeep).normalized();
  return make_pose(z * axis, axis, Vec3::UnitY());
}

inline LayerTable sway_layers(bool membranes) {
  constexpr std::array<double, 4> kForces{1, 2, 1.5, 2.5};          // N
  constexpr std::array<double, 4> kStiffness{1500, 500, 500, 500};  // N/m
  constexpr std::array<double, 4> kPuncture{1.5, 0, 2, 0};          // N
  std::vector<LayerHaptics> rows(kFirstRegion);
  for (std::size_t i = 0; i < kForces.size(); ++i) {
    Haptic h;
    h.cutting_force = kForces[i];
    h.wall_stiffness = kStiffness[i];
    h.attracted_force = 0.25 * kForces[i];
    h.friction = 1;
    h.clamping_stiffness = 200;
    h.puncture_force = membranes ? kPuncture[i] : 0;
    rows.push_back({h, CuttingLaw::tracking_wall, PrepunctureLaw::membrane});
  }
  return LayerTable(std::move(rows));
}

/// Runs it at `rate`, Hz; `each(tick number, pose, model)` after every tick.
template <class Each>
void run_sway(int rate, const Sway& sway, const LayerTable& table, Each each) {
  const AnalyticBody body =
      AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, sway.first_border, 0.018, 0.021});
  NeedleModel model(NeedleParams{}, table, 1.0 / rate);
  std::array<TissueInterval, 64> buffer{};
  const SwayPath path(sway.back);
  const int ticks = static_cast<int>(path.duration() * rate);
  for (int i = 0; i <= ticks; ++i) {
    const Pose X_JN = sway_pose(path, sway, static_cast<double>(i) / rate);
    const QueryCount met = body.find_intervals(model.query_segment(X_JN), buffer);
    model.step(X_JN, std::span<const TissueInterval>(buffer.data(), met.size));
    each(i, X_JN, model);
  }
}

}  // namespace artus::test
