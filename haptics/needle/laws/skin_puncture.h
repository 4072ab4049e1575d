// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>

#include "artus/core/geometry.h"
#include "artus/detail/core/check.h"

namespace artus {

/// Where a needle is that has no line yet. Frame J.
struct NeedlePlace {
  Vec3 tip = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double depth = 0;  ///< m along the needle, negative before the skin, -infinity: no skin ahead
};

/// What the skin remembers of a needle that is not in it: how far it has been from the hole that it
/// left, and where it was a tick ago, so that a puncture is placed where it happened and not at
/// the next tick. A needle that left by a hair finds its hole; the skin is whole for one that was
/// `edge` above it, or as much farther aside than the skin goes with a tip. In between its strength
/// grows with the path, so that a hair more or less is none.
class SkinPuncture {
 public:
  /// Requires: edge > 0 m.
  explicit SkinPuncture(double edge) noexcept : edge_(edge) {}

  /// Nothing is remembered: the skin is whole.
  ARTUS_REALTIME void forget() noexcept {
    away_ = edge_;
    known_ = false;
  }

  /// The needle left the skin at `hole`, and is at `now`.
  ARTUS_REALTIME void leave(const Vec3& hole, const NeedlePlace& now) noexcept {
    hole_ = hole;
    away_ = 0;
    wait(now);
  }

  /// A tick outside the skin.
  ARTUS_REALTIME void wait(const NeedlePlace& now) noexcept {
    go_away(now);
    remember(now);
  }

  /// A tick in which the tip pushes the skin in, or is through. Before remember().
  ARTUS_REALTIME void touch(const NeedlePlace& now) noexcept {
    if (!known_ || last_.depth < 0) go_away(between(now, 0));
  }

  ARTUS_REALTIME void remember(const NeedlePlace& now) noexcept {
    last_ = now;
    known_ = std::isfinite(now.depth);
  }

  /// The needle at `depth` m on its way from the last tick to `now`; `now` where that is not known.
  [[nodiscard]] ARTUS_REALTIME NeedlePlace between(const NeedlePlace& now,
                                                   double depth) const noexcept;

  /// How far the skin was pushed in a tick ago, m, at most `now`.
  [[nodiscard]] ARTUS_REALTIME double last_dimple(double now) const noexcept {
    return known_ ? std::clamp(last_.depth, 0.0, now) : now;
  }

  /// Share of its strength that the skin has.
  [[nodiscard]] ARTUS_REALTIME double wholeness() const noexcept { return away_ / edge_; }

 private:
  static constexpr double kAside = 2e-3;  // m that skin goes with a tip; assumed

  void go_away(const NeedlePlace& now) noexcept;

  double edge_;
  Vec3 hole_ = Vec3::Zero();
  double away_ = edge_;  // m, at most edge_
  bool known_ = false;
  NeedlePlace last_;
};

}  // namespace artus
