// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/core/check.h"

namespace artus {

/// What the syringe did in one tick.
struct SyringeTick {
  double time = 0;          ///< s
  double flow = 0;          ///< m^3/s out of the tip
  double given = 0;         ///< m^3 out of the tip in all; what is drawn is apart
  double thumb = 0;         ///< N on the thumb, positive out of the barrel
  double pressure = 0;      ///< Pa in the barrel, above the air's
  RegionId region = 0;      ///< at the tip
  Vec3 tip = Vec3::Zero();  ///< m, frame J
  /// What places hold of what was given, m^3, by their regions; those without a volume are none.
  struct Held {
    RegionId region = 0;
    double volume = 0;
  };
  std::array<Held, 4> held{};
};

/// Liquid given in one place.
struct Dose {
  double volume = 0;        ///< m^3
  RegionId region = 0;      ///< where it went: of the place that took the most; else at the tip
  Vec3 tip = Vec3::Zero();  ///< m, frame J, when the last of it was given
  double time = 0;          ///< s, then
};

/// Totals of a syringe's use, SI.
struct SyringeTotals {
  bool used = false;              ///< something was given or drawn, or the thumb pressed
  double given = 0;               ///< m^3, all that went in, whatever was drawn back
  double flowing = 0;             ///< s with more than 1 ul/s
  double busy = 0;                ///< s that it flowed, sucked or the thumb pressed or pulled
  double peak_flow = 0;           ///< m^3/s
  double peak_thumb = 0;          ///< N
  double peak_pressure = 0;       ///< Pa
  double peak_flow_time = 0;      ///< s, when that flow was first reached
  double peak_pressure_time = 0;  ///< s
  double tip_drift = 0;           ///< m, farthest from where a flow began while it lasted
  double test_dose = 0;           ///< m^3 before the first pause; 0 when nothing came after a pause
  int pauses = 0;                 ///< of 2 s or more between two flows
  int aspirations = 0;            ///< times that the barrel sucked (below -5 kPa) for 2 s or more
  bool aspirated_first = false;   ///< one of them before anything was given
};

/// Follows a syringe tick by tick.
class SyringeCourse {
 public:
  /// Memory for so many doses of 0.01 ml is taken here; what comes later adds to the last.
  explicit SyringeCourse(std::size_t max_doses = 10000);

  /// Cost: constant.
  ARTUS_REALTIME void add(const SyringeTick& tick) noexcept;

  [[nodiscard]] const SyringeTotals& totals() const noexcept { return sum_; }
  /// In the order in which they were given; their volumes add up to `given`.
  [[nodiscard]] const std::vector<Dose>& doses() const noexcept { return doses_; }

 private:
  void give(const SyringeTick& tick, double volume) noexcept;
  [[nodiscard]] RegionId place_of(const SyringeTick& tick) const noexcept;

  SyringeTotals sum_;
  std::vector<Dose> doses_;
  SyringeTick last_;
  Vec3 flow_began_ = Vec3::Zero();
  double flow_ended_ = 0;     // s
  double suction_began_ = 0;  // s
  bool started_ = false;
  bool flows_ = false;
  bool sucks_ = false;
  bool counted_ = false;  // this suction
};

}  // namespace artus
