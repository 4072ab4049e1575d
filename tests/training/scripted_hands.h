// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/core/units.h"
#include "artus/detail/training/assessment.h"
#include "tests/session/session_support.h"

namespace artus::test {

/// The bursa of the layered scene as target.
inline Goals bursa_goals(const CompiledJoint& joint) {
  GoalNames names;
  names.structure = "bursa";
  return *make_goals(joint, names);
}

/// Both hands over six flat layers, told at 100 Hz; the needle in the picture's plane at 35 degrees
/// to the probe's face unless said otherwise.
class ScriptedHands {
 public:
  explicit ScriptedHands(double face_angle = 35)
      : ScriptedHands(face_angle, bursa_goals(make_layered_scene()->joint())) {}
  ScriptedHands(double face_angle, Goals goals) {
    axis_ = Vec3(std::cos(face_angle * kDegree), 0, std::sin(face_angle * kDegree));
    MeterOptions options;
    options.longest = 900;
    options.goals = std::move(goals);
    meter_ = std::make_unique<AttemptMeter>(scene_, options);
  }
  /// Tip from its depth to `depth` in mm along the needle's line, which meets the point (0, aside,
  /// 15 mm); the probe slides by `slide` mm.
  void go(double seconds, double depth, double slide = 0) {
    const double from = depth_;
    const double probe = probe_;
    const int n = static_cast<int>(100 * seconds + 0.5);
    for (int i = 1; i <= n; ++i) {
      const double s = static_cast<double>(i) / n;
      depth_ = from + s * (depth - from);
      probe_ = probe + s * slide;
      time_ += 0.01;
      tell(tip(), axis_);
    }
  }
  /// Both hands keep their place but for a probe that sweeps 10 mm there and back.
  void sweep(double seconds) {
    for (double left = seconds; left > 0; left -= 2) {
      go(1, depth_, 10);
      go(1, depth_, -10);
    }
  }
  /// A tracker that flips its marker about the camera's axis for `n` samples, the hub in its place.
  void flip(int n) {
    for (int i = 0; i < n; ++i) {
      time_ += 0.01;
      tell(tip() - 0.2 * axis_, -axis_);
    }
  }
  /// The syringe for some seconds with the needle at rest.
  void inject(double seconds, double ml_s, double kpa) {
    ml_s_ = ml_s;
    kpa_ = kpa;
    go(seconds, depth_);
    ml_s_ = kpa_ = 0;
  }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] AttemptMeasures measure() const { return meter_->measure(); }
  bool feels = false;  ///< the hand feels forces, of which none is of bone
  double aside = 0;    ///< mm, of the needle from the plane
  double along = 0;    ///< mm, of the needle's line from the point along the face

 private:
  [[nodiscard]] Vec3 tip() const {
    return Vec3(1e-3 * along, 1e-3 * aside, 15e-3) + axis_ * ((1e-3 * depth_ - 15e-3) / axis_.z());
  }
  void tell(const Vec3& tip_J, const Vec3& axis) {
    const Pose X_JN = make_pose(tip_J, axis, Vec3::UnitY());
    const Pose X_JP = make_pose(Vec3(1e-3 * probe_ - 5e-3, 0, 0), Vec3::UnitZ(), Vec3::UnitX());
    meter_->add_needle(time_, X_JN.translation(), Eigen::Quaterniond(X_JN.linear()));
    meter_->add_probe(time_, X_JP.translation(), Eigen::Quaterniond(X_JP.linear()));
    if (feels) {
      FeltTick felt;
      felt.time = time_;
      felt.tip = tip_J;
      meter_->add_felt(felt);
    }
    give();
  }
  void give() {
    given_ += 1e-8 * std::max(0.0, ml_s_);
    SyringeTick tick{time_,      1e-6 * ml_s_, given_, ml_s_ > 0 ? 20.0 : 0.0,
                     1e3 * kpa_, kOutside,     tip()};
    const auto region = find_region(scene_->joint(), depth_ > 22 ? "bursa" : "muscle");
    tick.region = *region;
    meter_->add_syringe(tick);
  }

  std::shared_ptr<const Scene> scene_ = make_layered_scene();
  std::unique_ptr<AttemptMeter> meter_;
  Vec3 axis_;
  double time_ = 0;
  double depth_ = -5;  // mm
  double probe_ = 0;   // mm
  double given_ = 0;   // m^3
  double ml_s_ = 0;
  double kpa_ = 0;
};

}  // namespace artus::test
