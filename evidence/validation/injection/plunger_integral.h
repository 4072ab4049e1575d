// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <vector>

#include "artus/detail/haptics/plunger/plunger.h"

namespace artus {

/// What a thumb does, as functions of time: it presses with `force` (N) and, through a spring of
/// `stiffness` (N/m), leads the plunger to `place` (m).
struct ThumbCourse {
  std::function<double(double t)> force;
  std::function<double(double t)> place;
  double stiffness = 0;
};

/// One place behind one bore of a thin liquid, without leaks.
struct IntegralSetup {
  PlungerParams plunger;  ///< its syringe, needle, Newtonian liquid and entry_loss are used
  SpaceLaw law;
  ThumbCourse thumb;
};

/// Where the integral stood at a time.
struct IntegralRow {
  double time = 0;      ///< s
  double travel = 0;    ///< m
  double volume = 0;    ///< m^3 in the place
  double pressure = 0;  ///< Pa in the barrel
  double flow = 0;      ///< m^3/s
  double force = 0;     ///< N of the thumb
};

/// The equations of docs/injection.md by another way than the plunger's: continuous in time, by the
/// classical method of fourth order, in steps of `step` s that end where the stopper breaks loose
/// or comes to rest or the place opens, found by bisection; flow, film and pressure of the place
/// are written out here again. It shares the laws with the plunger, not a line of code. The stopper
/// does not age. A row at each multiple of `each` s up to `seconds`. Requires: a Newtonian liquid.
/// Cost: 0.3 us a step.
[[nodiscard]] std::vector<IntegralRow> integrate_plunger(const IntegralSetup& setup, double seconds,
                                                         double each, double step);

}  // namespace artus
