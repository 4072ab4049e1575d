// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/motion_gate.h"

#include <algorithm>

namespace artus {

bool MotionGate::reaches(const Place& from, double time, const Vec3& p,
                         const Eigen::Quaterniond& q) noexcept {
  constexpr double kShortest = 1e-3;  // s: poses of one instant are two of a fast device
  if (time - from.time > kGap) return true;
  const double dt = std::clamp(time - from.changed, kShortest, kLongest);
  return (p - from.p).norm() <= kMaxSpeed * dt && from.q.angularDistance(q) <= kMaxTurn * dt;
}

void MotionGate::move(Place& place, double time, const Vec3& p,
                      const Eigen::Quaterniond& q) noexcept {
  if (p != place.p || q.coeffs() != place.q.coeffs()) place.changed = time;
  place.time = time;
  place.p = p;
  place.q = q;
}

bool MotionGate::passes(double time, const Vec3& p, const Eigen::Quaterniond& q) noexcept {
  put_ = false;
  if (!started_) {
    last_ = {time, time, p, q};
    return started_ = true;
  }
  if (reaches(last_, time, p, q)) {
    away_ = false;
    move(last_, time, p, q);
    return true;
  }
  if (!away_ || !reaches(elsewhere_, time, p, q)) {
    first_there_ = elsewhere_ = {time, time, p, q};
    away_ = true;
    ++left_out_;
    return false;
  }
  const bool repeated = p == elsewhere_.p && q.coeffs() == elsewhere_.q.coeffs();
  move(elsewhere_, time, p, q);
  if (time - first_there_.time < kStay) {
    if (!repeated) ++left_out_;
    return false;
  }
  away_ = false;
  put_ = true;
  last_ = elsewhere_;
  return true;
}

void MotionGate::add(double time, const Vec3& p, const Eigen::Quaterniond& q,
                     PoseSampler& track) noexcept {
  if (!passes(time, p, q)) return;
  if (put_) {
    // The hand was where it had been until it was seen elsewhere.
    constexpr double kInstant = 1e-6;  // s
    track.add(first_there_.time - kInstant, before_.p, before_.q);
    track.add(first_there_.time, first_there_.p, first_there_.q);
  }
  before_ = last_;
  track.add(time, p, q);
}

std::string left_out_notice(const char* hand, std::uint64_t poses) {
  if (poses == 0) return "";
  return std::to_string(poses) + (poses == 1 ? " pose of the " : " poses of the ") + hand +
         (poses == 1 ? " was left out: it was" : " were left out: they were") +
         " where no hand gets so fast, as a tracker that flips its marker says";
}

}  // namespace artus
