// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string_view>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/haptics/plunger/patient.h"
#include "artus/detail/simulation/records.h"
#include "artus/raycast/scene.h"

namespace artus {

/// What is to be told of the syringe in one tick, from the truth.
struct SyringeReading {
  bool used = false;     ///< something came out, or a thumb is on it
  double left = 0;       ///< m^3 in it, of the liquid
  double given = 0;      ///< m^3
  double drawn = 0;      ///< m^3 of the patient's own in it, once it is seen in the barrel
  std::string_view own;  ///< what that is, where the tip is now, of `spaces`; empty: not known
  double flow = 0;       ///< m^3/s
  double thumb = 0;      ///< N, positive out of the barrel
  double pressure = 0;   ///< Pa at the tip
  PatientFeeling patient = PatientFeeling::nothing;
};

/// `params`: of the session. `spaces`: of the scene's joint. Cost: one query.
[[nodiscard]] SyringeReading read_syringe(const Scene& scene, const JointSpaces& spaces,
                                          const HapticSnapshot& now,
                                          const SessionParams& params) noexcept;

}  // namespace artus
