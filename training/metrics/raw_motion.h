// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <string>
#include <vector>

#include "artus/detail/training/metrics/closed_body.h"
#include "artus/detail/training/metrics/metric.h"
#include "artus/detail/training/metrics/swept_area.h"

namespace artus {

/// Runs of a signal above a threshold that last: a state changes when the signal has been on its
/// other side for longer than `hold`. Source [PerkTutor], actions.
class ActionCounter {
 public:
  ActionCounter(double threshold, double hold) : threshold_(threshold), hold_(hold) {}
  void add(double time, double value) noexcept;
  [[nodiscard]] int count() const noexcept { return count_; }

 private:
  double threshold_;
  double hold_;       // s
  double since_ = 0;  // s, when the state was last confirmed
  bool on_ = false;
  int count_ = 0;
};

/// Motion of one hand from its poses as recorded, unfiltered, by the conventions of PerkTutor, so
/// that its tables can be compared: lengths of the steps of the pose's origin; a step counts as in
/// tissue when it ENDS inside; swept area needs both ends inside; actions from the displacement of
/// the world's origin (M_i M_{i-1}^-1), 50 mm/s or 50 deg/s for more than 0.2 s; smoothness the
/// root of the integral of squared jerk by backward differences. Poses of one time move, but have
/// no speed. Source [PerkTutor].
class RawMotion {
 public:
  /// `body`: may be null: then nothing is said about tissue. `needle`: whether z is a shaft.
  RawMotion(std::shared_ptr<const Scene> body, bool needle);

  /// `given`: the orientation as the tracker's matrix has it, which is a little off a rotation and
  /// which PerkTutor inverts as it is; its rotations are those. Empty: that of the pose.
  /// Requires: a rigid pose, m; times that do not fall, s. Cost: a few queries.
  void add(double time, const Pose& X_JB,
           const std::optional<Eigen::Matrix3d>& given = std::nullopt);

  /// The table's rows, in PerkTutor's names and units (mm).
  [[nodiscard]] std::vector<Metric> metrics(const std::string& role) const;

 private:
  void add_tissue(double time, const Pose& X_JB, double step);
  void add_speeds(double time, const Pose& X_JB, const Eigen::Matrix3d& turn);
  void add_jerk(double time, const Vec3& p);
  void add_puncture(const Pose& X_JB, bool inside);

  std::shared_ptr<const Scene> body_;
  bool needle_;
  bool started_ = false;
  double time_ = 0;
  Pose last_ = Pose::Identity();
  Eigen::Matrix3d last_turn_ = Eigen::Matrix3d::Identity();  // as given
  bool inside_ = false;
  std::optional<NeedleInside> shaft_;
  double elapsed_ = 0;      // s
  double path_ = 0;         // m
  double turned_ = 0;       // rad
  double tissue_path_ = 0;  // m
  double tissue_time_ = 0;  // s
  double swept_ = 0;        // m^2
  bool armed_ = true;
  int punctures_ = 0;
  ActionCounter translations_{0.05, 0.2};             // m/s, s
  ActionCounter rotations_{0.8726646259971648, 0.2};  // rad/s: 50 degrees; s
  std::array<double, 3> times_{};                     // s, the last distinct ones, newest first
  std::array<Vec3, 3> points_{};
  std::size_t n_points_ = 0;
  double squared_jerk_ = 0;  // m^2/s^5
};

}  // namespace artus
