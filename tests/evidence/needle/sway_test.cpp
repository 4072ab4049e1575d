// SPDX-License-Identifier: AGPL-3.0-or-later
// A needle that sways while it is drawn back and pushed in again: whatever the loop's rate, the
// same forces. Poses are of time alone, so that each rate samples one path.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/evidence/needle/analytic_body.h"
#include "artus/haptics/needle/needle_model.h"

namespace artus {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr int kPhases = 20;
constexpr double kFrom = -0.005;  // m
constexpr double kDeep = 0.025;   // m, first insertion
constexpr double kAgain = 0.022;  // m, second
constexpr double kIn = 0.015;     // m/s
constexpr double kOut = 0.020;    // m/s

struct Sway {
  double back = 0;      // m, depth that the needle is drawn back to
  double phase = 0;     // rad
  bool pivots = false;  // about the entry; else the needle stays parallel to itself
  bool membranes = true;
};

// In, a rest of 0.3 s, back, 50 ms, in again, a rest of 0.5 s.
class Path {
 public:
  explicit Path(double back) : back_(back) {
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

 private:
  double back_;
  std::vector<double> times_;
};

// 1 mm at 4 Hz.
Pose pose_at(const Path& path, const Sway& sway, double t) {
  const double z = path.depth(t);
  const double aside = 1e-3 * std::sin(kTwoPi * 4 * t + sway.phase);
  if (!sway.pivots) return make_pose(Vec3(aside, 0, z), Vec3::UnitZ(), Vec3::UnitY());
  const Vec3 axis = Vec3(aside, 0, kDeep).normalized();
  return make_pose(z * axis, axis, Vec3::UnitY());
}

LayerTable layers(bool membranes) {
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

// Total force at each millisecond, frame J.
std::vector<Vec3> forces_at(int rate, const Sway& sway) {
  const LayerTable table = layers(sway.membranes);
  const AnalyticBody body =
      AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0, 0.0041, 0.018, 0.021});
  NeedleModel model(NeedleParams{}, table, 1.0 / rate);
  std::array<TissueInterval, 64> buffer{};
  const Path path(sway.back);
  std::vector<Vec3> out;
  const int ticks = static_cast<int>(path.duration() * rate);
  for (int i = 0; i <= ticks; ++i) {
    const Pose X_JN = pose_at(path, sway, static_cast<double>(i) / rate);
    const QueryCount met = body.find_intervals(model.query_segment(X_JN), buffer);
    const NeedleForces& f =
        model.step(X_JN, std::span<const TissueInterval>(buffer.data(), met.size));
    if (i % (rate / 1000) == 0) out.push_back(f.total.force);
  }
  return out;
}

// RMS of the difference over RMS of `reference`.
double rms_share(const std::vector<Vec3>& forces, const std::vector<Vec3>& reference) {
  double difference = 0;
  double size = 0;
  for (std::size_t i = 0; i < std::min(forces.size(), reference.size()); ++i) {
    difference += (forces[i] - reference[i]).squaredNorm();
    size += reference[i].squaredNorm();
  }
  return std::sqrt(difference / size);
}

double mean_aside_at_rest(const std::vector<Vec3>& forces) {
  constexpr std::size_t kRest = 500;  // ms, two periods of the sway
  double sum = 0;
  for (std::size_t i = forces.size() - kRest; i < forces.size(); ++i) sum += forces[i].x();
  return sum / kRest;
}

class SwayTest : public ::testing::TestWithParam<std::tuple<double, bool, bool>> {};

TEST_P(SwayTest, PushedInAgainFeelsAlikeAtAnyRateWhateverThePhase) {
  Sway sway;
  std::tie(sway.back, sway.pivots, sway.membranes) = GetParam();
  double worst = 0;
  for (int p = 0; p < kPhases; ++p) {
    sway.phase = kTwoPi * p / kPhases;
    const std::vector<Vec3> reference = forces_at(10000, sway);
    for (const int rate : {1000, 2000, 5000}) {
      const std::vector<Vec3> forces = forces_at(rate, sway);
      const double share = rms_share(forces, reference);
      worst = std::max(worst, share);
      EXPECT_LT(share, 0.02) << rate << " Hz, phase " << p;
      EXPECT_NEAR(mean_aside_at_rest(forces), mean_aside_at_rest(reference), 0.02)
          << rate << " Hz, phase " << p;
    }
  }
  RecordProperty("worst_rms_share", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(Depths, SwayTest,
                         ::testing::Combine(::testing::Values(0.018, 0.015, 0.012, 0.008, 0.005,
                                                              0.003, 0.002, 0.001, -0.002),
                                            ::testing::Bool(), ::testing::Bool()));

}  // namespace
}  // namespace artus
