// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "artus/detail/training/metrics/pose_track.h"

namespace artus {

/// Keeps from a track what no hand does: a tracker that flips its marker puts the needle elsewhere
/// for a frame and back. A pose further from the one before than 2 m/s or 20 rad/s reach in the
/// time since that one changed, 0.1 s at most, is left out (assumed: a hand stays below 1 m/s, a
/// wrist below 20 rad/s). Where the poses stay for kStay, the hand was put there, as by a key that
/// goes back to the start: then all but the way there counts. No memory is taken.
class MotionGate {
 public:
  static constexpr double kMaxSpeed = 2;   ///< m/s
  static constexpr double kMaxTurn = 20;   ///< rad/s
  static constexpr double kLongest = 0.1;  ///< s that a motion between two poses may have taken
  static constexpr double kStay = 0.3;     ///< s
  static constexpr double kGap = 0.5;      ///< s without poses after which any may come

  /// A pose on its way to `track`. Times must not fall. Cost: constant.
  ARTUS_REALTIME void add(double time, const Vec3& p, const Eigen::Quaterniond& q,
                          PoseSampler& track) noexcept;
  /// The same for who keeps poses one by one: whether this one counts.
  [[nodiscard]] bool passes(double time, const Vec3& p, const Eigen::Quaterniond& q) noexcept;
  /// Poses that were left out; one that a device repeats counts once.
  [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_; }

 private:
  struct Place {
    double time = 0;     ///< s, when it came
    double changed = 0;  ///< s, when a pose last differed from the one before it
    Vec3 p = Vec3::Zero();
    Eigen::Quaterniond q{1, 0, 0, 0};
  };
  [[nodiscard]] static bool reaches(const Place& from, double time, const Vec3& p,
                                    const Eigen::Quaterniond& q) noexcept;
  static void move(Place& place, double time, const Vec3& p, const Eigen::Quaterniond& q) noexcept;

  Place last_;       // that counted
  Place before_;     // the one that was added before it
  Place elsewhere_;  // that did not
  Place first_there_;
  bool started_ = false;
  bool away_ = false;
  bool put_ = false;  // the last one ended a stay elsewhere
  std::uint64_t left_out_ = 0;
};

/// What people are told of the poses of a hand that were left out; empty: none were.
[[nodiscard]] std::string left_out_notice(const char* hand, std::uint64_t poses);

}  // namespace artus
