// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <span>
#include <vector>

#include "artus/soft/bolus.h"

namespace artus {

/// Points on the surfaces of bones within 60 mm of `around`, frame J, at most 1 mm apart. Cost:
/// linear in the interfaces.
[[nodiscard]] std::vector<Vec3> find_bone_points(const CompiledJoint& joint, const Vec3& around);

/// How one bolus moves what is around it. What is above its sheet goes up, what is below goes down,
/// along the bolus's last axis alone, by the opening at its place: within 10 mm as it is, farther
/// away less and over a wider area, so that the same volume passes every level. So nothing passes
/// anything else. A side on which bone lies stays shut there, as a plate that is held 3 mm beside
/// it.
class Cleft {
 public:
  /// `bone`: find_bone_points. Requires: volume and proportions above 0.
  Cleft(const Bolus& bolus, std::span<const Vec3> bone);

  /// 0 .. 1, of the opening that goes up (down): what bone leaves of it.
  [[nodiscard]] double free_share(bool up) const noexcept { return sides_[up ? 1 : 0].free; }
  /// Where a point of frame J comes to. Cost: below 0.1 us.
  [[nodiscard]] Vec3 moved(const Vec3& p) const;
  /// Of its own wall, for a point of the unit sphere.
  [[nodiscard]] Vec3 wall(const Vec3& unit) const;
  /// (x, y, height above the sheet), each of the order of one beside it.
  [[nodiscard]] Vec3 local(const Vec3& p) const;
  /// Makes it open by `factor` of what it did.
  void scale(double factor) noexcept { opening_ *= factor; }

 private:
  struct Side {
    double part = 0;           // of the opening
    double free = 1;           // of that
    std::vector<double> room;  // m to where bone keeps it shut; empty: nowhere
  };
  [[nodiscard]] double open_at(const Side& side, double x, double y) const;
  [[nodiscard]] double sheet(double x, double y) const;
  void mark(Side& side, double x, double y) const;
  void finish(Side& side) const;

  Bolus bolus_;
  Vec3 half_ = Vec3::Ones();  // m, semi-axes
  double opening_ = 0;        // m in the middle
  double spread_ = 1;         // m from the sheet at which the lift is twice as wide
  int nodes_x_ = 0;           // of the room's map, to either side
  int nodes_y_ = 0;
  std::array<Side, 2> sides_;  // below, above
};

}  // namespace artus
