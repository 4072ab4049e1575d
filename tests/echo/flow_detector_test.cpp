// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/flow_detector.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/acquire/doppler.h"
#include "artus/detail/echo/acquire/line_shaping.h"
#include "artus/detail/echo/medium/vessel.h"

namespace artus {
namespace {

constexpr double kRadius = 4e-3;  // m
constexpr RegionId kVessel = kFirstRegion;
const float kNothing = std::numeric_limits<float>::quiet_NaN();

/// Coordinates (z, y, x) of the place: the third runs along x.
MaterialMap along_x() {
  MaterialMap::Coefficients coefficients = MaterialMap::Coefficients::Zero();
  // Which terms are linear is read from their slopes at the origin.
  const MaterialMap::Slopes slopes = MaterialMap::slopes(Vec3::Zero());
  for (int term = 0; term < static_cast<int>(MaterialMap::kTerms); ++term)
    for (int axis = 0; axis < 3; ++axis)
      if (slopes(axis, term) != 0) coefficients(term, 2 - axis) = 1;
  return {Vec3::Zero(), 1, coefficients};
}

/// A round vessel along x below the face's middle, `cosine` of whose blood's velocity is against
/// the beams, at the middle of the picture's depth; its beam passes `aside` (m) of its axis.
class Flow : public testing::Test {
 protected:
  Flow() {
    transducer_.n_lines = 32;
    settings_.doppler = true;
    settings_.doppler_limit = 3;
    settings_.tgc_db_cm_mhz = 0;
    shape_ = std::make_unique<BeamShape>(transducer_, settings_);
    frame_.n_lines = transducer_.n_lines;
    frame_.n_samples = settings_.n_samples;
    const auto size = static_cast<std::size_t>(frame_.n_lines * frame_.n_samples);
    for (auto* stage : {&frame_.in_phase, &frame_.quadrature, &frame_.motion_db})
      stage->resize(size);
    frame_.shadow_from.resize(32, 1e4F);
    regions_.resize(kVessel + 1);
    regions_[kVessel].backscatter = 1;
  }

  void put_vessel(bool is_artery, double towards) {
    regions_[kVessel].vessel =
        std::make_shared<const Vessel>(Vessel{is_artery, kRadius, towards, along_x()});
  }

  /// A beam that runs down at `angle` (rad) from z toward x, through tissue and the vessel.
  BeamTrace* beam(double angle, double aside, const Vec3& moved = Vec3::Zero()) {
    trace_ = std::make_unique<BeamTrace>();
    const Vec3 direction(std::sin(angle), 0, std::cos(angle));
    const double half = std::sqrt(kRadius * kRadius - aside * aside) / std::cos(angle);
    const double step = shape_->sample_depth();
    const double middle = 512;
    const std::array<double, 4> borders{0, middle - half / step, middle + half / step, 1023};
    for (std::size_t i = 0; i < 3; ++i) {
      BeamRun& run = trace_->runs[i];
      run = {};
      run.region = i == 1 ? kVessel : RegionId{1};
      run.begin = borders[i];
      run.end = borders[i + 1];
      run.step_J = step * direction;
      run.direction_J = direction;
      run.p_J = Vec3(0, aside, 20e-3) + (borders[i] - middle) * run.step_J;
      run.path_begin = step * run.begin;
      run.path_end = step * run.end;
      if (moved.norm() == 0) continue;
      run.n_knots = 2;
      trace_->knots[0] = {0, Vec3(0, aside, 20e-3) - middle * run.step_J - moved, moved.norm(), 0};
      trace_->knots[1] = {1, trace_->knots[0].rest_J + direction, moved.norm(), 0};
    }
    trace_->n_runs = 3;
    return trace_.get();
  }

  /// Colours a frame in which all lines have the same beam.
  void see(FlowDetector& flow, const BeamTrace& trace, std::optional<double> time) {
    frame_.velocity.assign(frame_.in_phase.size(), kNothing);
    flow.begin_frame(time);
    for (int l = 0; l < 32; ++l) flow.note(l, trace, regions_, 1);
    const std::vector<float> gain(static_cast<std::size_t>(settings_.n_samples), 1.0F);
    flow.colour(gain, workers_, frame_);
  }
  [[nodiscard]] float at(int l, int sample) const {
    return frame_.velocity[static_cast<std::size_t>(l * frame_.n_samples + sample)];
  }

  Transducer transducer_;
  ImageSettings settings_;
  std::unique_ptr<BeamShape> shape_;
  std::vector<RegionAcoustics> regions_;
  std::unique_ptr<BeamTrace> trace_;
  BlockWorkers workers_{1};
  Frame frame_;
};

TEST_F(Flow, BloodInTheMiddleShowsItsVelocityAlongTheBeam) {
  put_vessel(true, 1);  // blood toward +x
  FlowDetector flow(transducer_, settings_, *shape_);
  const double systole = 0.125;
  const double peak = kArterialRate * 2 * kRadius;
  EXPECT_NEAR(regions_[kVessel].vessel->middle_speed(systole), peak, 1e-9);
  for (const double degrees : {-60.0, -20.0, 30.0, 60.0}) {
    see(flow, *beam(degrees * kDegree, 0), systole);
    const double along = std::sin(degrees * kDegree);
    // A packet and a beam blur the top of the parabola a little.
    EXPECT_NEAR(at(16, 512), -peak * along, 0.01 * peak) << degrees;
    EXPECT_TRUE(std::isnan(at(16, 100)));
    EXPECT_TRUE(std::isnan(at(16, 900)));
  }
}

TEST_F(Flow, WhatRunsAcrossTheBeamShowsNoColour) {
  put_vessel(true, 1);
  FlowDetector flow(transducer_, settings_, *shape_);
  see(flow, *beam(0, 0), 0.125);
  for (int s = 0; s < settings_.n_samples; ++s) ASSERT_TRUE(std::isnan(at(16, s))) << s;
}

TEST_F(Flow, TheProfileIsAParabolaAndFallsToTheSide) {
  put_vessel(true, 1);
  settings_.doppler_limit = 2;
  FlowDetector flow(transducer_, settings_, *shape_);
  const double angle = 30 * kDegree;
  see(flow, *beam(angle, 0), 0.125);
  const double top = at(16, 512);
  const double half_chord = kRadius / std::cos(angle) / shape_->sample_depth();
  for (const double share : {0.3, 0.5, 0.7})
    EXPECT_NEAR(at(16, 512 + static_cast<int>(share * half_chord)), top * (1 - share * share),
                0.03 * std::abs(top));
  see(flow, *beam(angle, 0.6 * kRadius), 0.125);
  EXPECT_NEAR(at(16, 512), top * (1 - 0.36), 0.02 * std::abs(top));
}

TEST_F(Flow, FastBloodWrapsRoundAtTheLimit) {
  put_vessel(true, 1);
  settings_.doppler_limit = 0.5;
  FlowDetector flow(transducer_, settings_, *shape_);
  see(flow, *beam(30 * kDegree, 0), 0.125);
  const double toward = -kArterialRate * 2 * kRadius * 0.5;  // -0.544 m/s
  EXPECT_NEAR(at(16, 512), wrap_velocity(toward, 0.5), 0.02);
  EXPECT_GT(at(16, 512), 0) << "away so fast that it looks like toward";
}

TEST_F(Flow, ArteriesBeatAndTurnRoundVeinsBreathe) {
  const Vessel artery{true, kRadius, 1, along_x()};
  const Vessel vein{false, kRadius, 1, along_x()};
  double least = 0;
  double most = 0;
  double mean = 0;
  for (int i = 0; i < 1000; ++i) {
    const double t = i * 4e-3;  // 4 s: one breath
    least = std::min(least, artery.middle_speed(t));
    most = std::max(most, artery.middle_speed(t));
    EXPECT_GT(vein.middle_speed(t), 0);
    mean += vein.middle_speed(t) / 1000;
    EXPECT_NEAR(artery.middle_speed(t), artery.middle_speed(t + 60.0 / 72), 1e-9);
  }
  EXPECT_NEAR(most, kArterialRate * 2 * kRadius, 1e-3);
  EXPECT_NEAR(least, -0.25 * most, 0.01 * most);
  EXPECT_NEAR(mean, 0.15, 1e-6);
}

TEST_F(Flow, TissueThatMovesPastTheFaceFlashesAndAtRestDoesNot) {
  settings_.doppler_limit = 0.1;
  std::fill(frame_.in_phase.begin(), frame_.in_phase.end(), 0.05F);
  FlowDetector flow(transducer_, settings_, *shape_);
  see(flow, *beam(0, 0), 1.0);
  for (int s = 0; s < settings_.n_samples; ++s) ASSERT_TRUE(std::isnan(at(16, s))) << s;
  // In 33 ms the tissue came 1 mm nearer: at each depth is what lay 1 mm deeper.
  see(flow, *beam(0, 0, Vec3(0, 0, -1e-3)), 1.033);
  EXPECT_NEAR(at(16, 200), 1e-3 / 0.033, 1e-6);
  EXPECT_NEAR(at(16, 800), 1e-3 / 0.033, 1e-6);
  see(flow, *beam(0, 0, Vec3(0, 0, -1e-3)), 1.066);
  EXPECT_TRUE(std::isnan(at(16, 200))) << "it rests again";
  // Frames far apart tell of no speed.
  see(flow, *beam(0, 0), 2.0);
  EXPECT_TRUE(std::isnan(at(16, 200)));
  // Nor does one for which no time is given.
  see(flow, *beam(0, 0, Vec3(0, 0, -1e-3)), std::nullopt);
  EXPECT_TRUE(std::isnan(at(16, 200)));
}

/// A round tube along z, `length` m, of tissue `name`, cut off at both ends by the border of the
/// region of interest, as tetrahedra.
CompiledJoint make_tube(const std::string& name, double length) {
  constexpr int kRound = 16;
  constexpr int kAlong = 24;
  CompiledJoint joint;
  joint.tissues.resize(1);
  joint.tissues[0].name = name;
  joint.tissues[0].acoustic.kind = TissueKind::fluid;
  joint.regions = {
      {"outside", 0, Vec3::Zero()}, {"beyond", 0, Vec3::Zero()}, {"vessel", 0, Vec3::Zero()}};
  for (int k = 0; k <= kAlong; ++k) {
    const double z = length * (static_cast<double>(k) / kAlong - 0.5);
    joint.mesh.vertices.emplace_back(0, 0, z);
    for (int i = 0; i < kRound; ++i) {
      const double angle = 2 * std::numbers::pi * i / kRound;
      joint.mesh.vertices.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), z);
    }
  }
  const auto at = [](int k, int i) {
    return static_cast<std::uint32_t>(k * (kRound + 1) + (i < 0 ? 0 : 1 + i % kRound));
  };
  const auto add = [&joint](std::array<std::uint32_t, 4> v) {
    joint.mesh.tetrahedra.push_back(v);
    joint.mesh.regions.push_back(kVessel);
    if (tet_volume(joint.mesh, joint.mesh.tetrahedra.size() - 1) < 0)
      std::swap(joint.mesh.tetrahedra.back()[0], joint.mesh.tetrahedra.back()[1]);
  };
  for (int k = 0; k < kAlong; ++k)
    for (int i = 0; i < kRound; ++i) {
      add({at(k, -1), at(k, i), at(k, i + 1), at(k + 1, -1)});
      add({at(k, i), at(k, i + 1), at(k + 1, -1), at(k + 1, i)});
      add({at(k, i + 1), at(k + 1, -1), at(k + 1, i), at(k + 1, i + 1)});
      joint.mesh.interfaces.push_back({{at(k, i), at(k, i + 1), at(k + 1, i)}, 0, kVessel});
      joint.mesh.interfaces.push_back({{at(k, i + 1), at(k + 1, i + 1), at(k + 1, i)}, 0, kVessel});
    }
  return joint;
}

TEST(FindVessel, ATubeHasItsRadiusAndItsBloodRunsAlongIt) {
  const auto artery = find_vessel(make_tube("artery", 80e-3), kVessel);
  const auto vein = find_vessel(make_tube("vein", 80e-3), kVessel);
  ASSERT_TRUE(artery && vein);
  EXPECT_TRUE(artery->is_artery);
  EXPECT_FALSE(vein->is_artery);
  EXPECT_NEAR(artery->radius, kRadius, 0.03 * kRadius);  // sixteen sides are not round
  for (const double x : {-3e-3, -1e-3, 0.0, 1e-3, 3e-3})
    for (const double z : {-25e-3, 0.0, 25e-3}) {
      EXPECT_LT(artery->direction(Vec3(x, 1e-3, z)).z(), -0.99) << x << ' ' << z;
      EXPECT_GT(vein->direction(Vec3(x, 1e-3, z)).z(), 0.99) << x << ' ' << z;
    }
  EXPECT_FALSE(find_vessel(make_tube("synovial_fluid", 80e-3), kVessel).has_value());
}

}  // namespace
}  // namespace artus
