// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/raw_motion.h"

#include <cmath>
#include <utility>

#include <Eigen/SVD>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kDegrees = 180 / 3.141592653589793;  // a radian
constexpr double kAround = 1e-3;                      // m before and behind the tip

bool is_inside(const Scene& body, const Vec3& p, const Vec3& axis) {
  return region_of_tip(body, p, axis) != kOutside;
}

/// The rotation that is least far from a matrix a little off one: the polar decomposition's.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace

void ActionCounter::add(double time, double value) noexcept {
  const bool on = value > threshold_;
  if (on == on_) {
    since_ = time;
  } else if (time - since_ > hold_) {
    on_ = on;
    since_ = time;
    if (on) ++count_;
  }
}

RawMotion::RawMotion(std::shared_ptr<const Scene> body, bool needle)
    : body_(std::move(body)), needle_(needle) {}

void RawMotion::add_puncture(const Pose& X_JB, bool inside) {
  const Vec3 axis = X_JB.linear().col(2);
  const Vec3 tip = X_JB.translation();
  const bool before = is_inside(*body_, tip + kAround * axis, axis);
  const bool behind = is_inside(*body_, tip - kAround * axis, axis);
  if (armed_ && inside && before && behind) {
    ++punctures_;
    armed_ = false;
  } else if (!inside && !before && !behind) {
    armed_ = true;
  }
}

void RawMotion::add_tissue(double time, const Pose& X_JB, double step) {
  const Vec3 tip = X_JB.translation();
  const bool inside = is_inside(*body_, tip, X_JB.linear().col(2));
  if (started_ && inside) {
    tissue_path_ += step;
    tissue_time_ += time - time_;
  }
  if (needle_) {
    std::optional<NeedleInside> shaft;
    if (inside)
      if (const auto entry = find_entry(*body_, tip, X_JB.linear().col(2)))
        shaft = NeedleInside{tip, *entry};
    if (shaft && shaft_ && inside_) swept_ += swept_area(*shaft_, *shaft);
    shaft_ = shaft;
    add_puncture(X_JB, inside);
  }
  inside_ = inside;
}

void RawMotion::add_speeds(double time, const Pose& X_JB, const Eigen::Matrix3d& turn) {
  const Eigen::Matrix3d moved = turn * last_turn_.inverse();
  const double angle = Eigen::AngleAxisd(nearest_rotation(moved)).angle();
  const Vec3 origin = X_JB.translation() - moved * last_.translation();  // of the world, as carried
  turned_ += angle;
  const double dt = time - time_;
  if (dt <= 0) return;
  translations_.add(time, origin.norm() / dt);
  rotations_.add(time, angle / dt);
}

void RawMotion::add_jerk(double time, const Vec3& p) {
  if (n_points_ > 0 && time == times_[0]) return;
  if (n_points_ == 3) {
    const double h0 = time - times_[0];
    const double h1 = times_[0] - times_[1];
    const double h2 = times_[1] - times_[2];
    const Vec3 v0 = (p - points_[0]) / h0;
    const Vec3 v1 = (points_[0] - points_[1]) / h1;
    const Vec3 v2 = (points_[1] - points_[2]) / h2;
    const Vec3 jerk = ((v0 - v1) / h0 - (v1 - v2) / h1) / h0;
    squared_jerk_ += jerk.squaredNorm() * h0;
  }
  for (std::size_t i = 2; i > 0; --i) {
    times_[i] = times_[i - 1];
    points_[i] = points_[i - 1];
  }
  times_[0] = time;
  points_[0] = p;
  if (n_points_ < 3) ++n_points_;
}

void RawMotion::add(double time, const Pose& X_JB, const std::optional<Eigen::Matrix3d>& given) {
  const Eigen::Matrix3d turn = given.value_or(Eigen::Matrix3d(X_JB.linear()));
  const double step = started_ ? (X_JB.translation() - last_.translation()).norm() : 0;
  if (started_) {
    elapsed_ += time - time_;
    path_ += step;
    add_speeds(time, X_JB, turn);
  }
  if (body_ != nullptr) add_tissue(time, X_JB, step);
  add_jerk(time, X_JB.translation());
  last_ = X_JB;
  last_turn_ = turn;
  time_ = time;
  started_ = true;
}

std::vector<Metric> RawMotion::metrics(const std::string& role) const {
  const MetricRule rule{"none", 0};
  std::vector<Metric> out;
  const auto put = [&](const char* name, const char* unit, double value, const char* what) {
    out.push_back({name, role, unit, value, what, rule});
  };
  if (!started_) return out;
  put("Elapsed Time", "s", elapsed_, "sum of the differences of the poses' times");
  put("Path Length", "mm", path_ / kMillimetre, "sum of the steps of the pose's origin");
  put("Rotation Total", "deg", turned_ * kDegrees, "sum of the steps' angles");
  put("Translational Actions", "count", translations_.count(),
      "runs of more than 50 mm/s of the world's origin as the hand carries it, changed state after "
      "0.2 s");
  put("Rotational Actions", "count", rotations_.count(),
      "runs of more than 50 deg/s, changed state after 0.2 s");
  put("Motion Smoothness", "mm/s^3", std::sqrt(squared_jerk_) / kMillimetre,
      "root of the integral of squared jerk, backward differences (mm/s^3 s^1/2)");
  if (body_ == nullptr) return out;
  put("Time in Tissue", "s", tissue_time_, "intervals that end with the origin inside");
  put("Path in Tissue", "mm", tissue_path_ / kMillimetre, "steps that end with the origin inside");
  if (!needle_) return out;
  put("Tissue Damage", "mm^2", swept_ / (kMillimetre * kMillimetre),
      "area between neighbouring shafts from tip to the skin on the line to 300 mm back; both ends "
      "inside");
  put("Tissue Punctures", "count", punctures_,
      "times that the tip and points 1 mm before and behind it are all inside; all three outside "
      "arm it again");
  return out;
}

}  // namespace artus
