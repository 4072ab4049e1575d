// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/evidence/runs/needle_trace.h"
#include "artus/detail/haptics/guard_fields.h"
#include "artus/detail/haptics/needle/needle_params_fields.h"

namespace artus {

/// The numbers, flags and choices of a tissue's haptic values, for visit_fields (core/fields.h).
ARTUS_FIELDS(Haptic, cutting_force, wall_stiffness, attracted_force, friction, clamping_stiffness,
             puncture_force, hard, cutting_law, prepuncture_law);

namespace test {

/// Everything that the forces of a scenario depend on.
struct ForceSetup {
  NeedleParams needle;
  GuardParams guard;
  PassivityParams passivity;
  DeviceLimits device;
  Haptic skin, muscle, bursa, fat, bone;
};
ARTUS_FIELDS(ForceSetup, needle, guard, passivity, device, skin, muscle, bursa, fat, bone);

/// A needle's way through a body that is known in closed form: flat layers or balls.
struct ForceScenario {
  std::string name;
  ForceSetup setup;
  std::function<std::vector<NeedleRow>(const ForceSetup&)> run;
};

/// Scenarios that between them use every law and every stage of the guards.
[[nodiscard]] std::vector<ForceScenario> make_force_scenarios();

/// The names of the regions in the scenarios' traces.
[[nodiscard]] std::vector<std::string> scenario_region_names();

/// The scenario's trace as write_needle_csv writes it, header first: every 25th row, and each row
/// in which something happens or changes (events, state, status, region).
[[nodiscard]] std::vector<std::string> trace_lines(const ForceScenario& scenario,
                                                   const ForceSetup& setup);

/// Where two traces differ by more than 1e-6 in a number (relative above 1) or at all in a word:
/// "row 7, cutting_n: 1.2 -> 1.3"; empty when they do not.
[[nodiscard]] std::string find_difference(const std::vector<std::string>& expected,
                                          const std::vector<std::string>& actual);

}  // namespace test
}  // namespace artus
