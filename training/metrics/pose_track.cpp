// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/pose_track.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/training/metrics/zero_phase.h"

namespace artus {
namespace {

constexpr double kStep = 1 / PoseSampler::kRate;  // s
constexpr double kCorner = 6;                     // Hz
constexpr std::size_t kEvery = 5;                 // of the even points is kept: 20 Hz
constexpr double kTiny = 1e-9;                    // s

}  // namespace

Pose pose_of(const TrackPoint& point) {
  Pose pose = Pose::Identity();
  pose.linear() = point.q.toRotationMatrix();
  pose.translation() = point.p;
  return pose;
}

MetricRule motion_rule() {
  return {"mean over 10 ms at 100 Hz, zero-phase Butterworth of order 2 at 6 Hz", kTrackRate};
}

PoseSampler::PoseSampler(double longest) {
  values_.reserve(static_cast<std::size_t>(std::max(0.0, longest) * kRate) + 2);
}

void PoseSampler::close_cell() noexcept {
  if (values_.size() == values_.capacity()) {
    full_ = true;
    return;
  }
  const bool whole = weight_ > kStep - kTiny;
  if (whole)
    values_.push_back(sum_ / weight_);
  else
    values_.push_back(centre_);
  sum_.setZero();
  weight_ = 0;
  has_centre_ = false;
}

/// The straight piece from `a` at `from` to `b` at `to`, all after the last one.
void PoseSampler::cross(double from, double to, const Value& a, const Value& b) noexcept {
  double at = from;
  while (!full_) {
    const double centre = static_cast<double>(values_.size()) * kStep;
    const double end = std::min(to, centre + 0.5 * kStep);
    const auto value_at = [&](double t) -> Value {
      return a + std::clamp((t - from) / (to - from), 0.0, 1.0) * (b - a);
    };
    if (end > at) {
      sum_ += (end - at) * value_at(0.5 * (at + end));
      weight_ += end - at;
      at = end;
    }
    if (!has_centre_ && to >= centre - kTiny) {
      centre_ = value_at(centre);
      has_centre_ = true;
    }
    if (to < centre + 0.5 * kStep) return;
    close_cell();
  }
}

void PoseSampler::add(double time, const Vec3& p, const Eigen::Quaterniond& q) noexcept {
  Value value;
  value << p, q.coeffs();
  if (!started_) {
    start_ = last_time_ = time;
    last_ = centre_ = value;
    started_ = has_centre_ = true;
    return;
  }
  if (value.tail<4>().dot(last_.tail<4>()) < 0) value.tail<4>() = -value.tail<4>();
  if (time > last_time_) {
    cross(last_time_ - start_, time - start_, last_, value);
    last_time_ = time;
  }
  last_ = value;
}

std::vector<TrackPoint> PoseSampler::points() const {
  std::vector<TrackPoint> out;
  out.reserve(values_.size() + 1);
  const auto put = [&](const Value& v) {
    TrackPoint point;
    point.time = start_ + static_cast<double>(out.size()) * kStep;
    point.p = v.head<3>();
    point.q.coeffs() = v.tail<4>();
    point.q.normalize();
    out.push_back(point);
  };
  for (const Value& v : values_) put(v);
  if (started_ && has_centre_ && !full_) put(centre_);
  return out;
}

std::vector<TrackPoint> smooth(const std::vector<TrackPoint>& points) {
  const LowPass filter = make_butterworth(kCorner, PoseSampler::kRate);
  std::vector<std::vector<double>> columns(7, std::vector<double>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector4d q = points[i].q.coeffs();
    if (i > 0) {  // one hemisphere all along
      const Eigen::Vector4d before(columns[3][i - 1], columns[4][i - 1], columns[5][i - 1],
                                   columns[6][i - 1]);
      if (q.dot(before) < 0) q = -q;
    }
    for (std::size_t k = 0; k < 3; ++k) columns[k][i] = points[i].p[static_cast<Eigen::Index>(k)];
    for (std::size_t k = 0; k < 4; ++k) columns[3 + k][i] = q[static_cast<Eigen::Index>(k)];
  }
  for (auto& column : columns) filter_zero_phase(filter, PoseSampler::kRate, column);
  std::vector<TrackPoint> out;
  out.reserve(points.size() / kEvery + 1);
  for (std::size_t i = 0; i < points.size(); i += kEvery) {
    TrackPoint point;
    point.time = points[i].time;
    point.p = Vec3(columns[0][i], columns[1][i], columns[2][i]);
    point.q = Eigen::Quaterniond(columns[6][i], columns[3][i], columns[4][i], columns[5][i]);
    point.q.normalize();
    out.push_back(point);
  }
  return out;
}

}  // namespace artus
