// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/core/check.h"

namespace artus {

/// Pressure of a place with `volume` m^3 put in (negative: taken out), Pa, without relaxation.
[[nodiscard]] ARTUS_REALTIME double pressure_of(const SpaceLaw& law, double volume) noexcept;

/// Pressure at the tip from which on something flows into a place that is not open to it, Pa.
[[nodiscard]] ARTUS_REALTIME double opening_of(const SpaceLaw& law, double volume) noexcept;

/// Derivative of pressure_of, Pa/m^3.
[[nodiscard]] ARTUS_REALTIME double slope_of(const SpaceLaw& law, double volume) noexcept;

/// Pa s/m^3 between the tip and the rest of a film whose walls touch, for a liquid of `viscosity`
/// Pa s: radial flow between plates, 6 mu ln(r_2/r_1)/(pi h^3), over a ratio of radii of 25. They
/// part around the tip first: h is the mean over a radius that grows as volume^(1/3), as drawn
/// liquid does, from 2.5 cm2 on to all of it at 3 ml (assumed). 0 without a film.
[[nodiscard]] ARTUS_REALTIME double film_resistance(const SpaceLaw& law, double volume,
                                                    double viscosity) noexcept;

}  // namespace artus
