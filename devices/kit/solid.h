// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/surfaces/surface_mesh.h"
#include "artus/detail/devices/kit/body.h"

namespace artus::kit {

/// Parts to print: closed, manifold surfaces in metres, each in the frame that is named.
/// The clip with the prism that holds a syringe's barrel; `barrel`: its diameter, m. Frame B of the
/// syringe. Requires: 8 to 22 mm.
[[nodiscard]] SurfaceMesh make_syringe_clip(double barrel);
/// The probe mock: prism, handle, face. Frame B of the probe.
[[nodiscard]] SurfaceMesh make_probe_mock(Hand hand);
/// The flag on the plunger's rest that carries its marker. Frame B of the syringe.
[[nodiscard]] SurfaceMesh make_plunger_flag(Hand hand);
/// A plate with two pits 60 mm apart that hold a needle's tip; origin between them, z up.
[[nodiscard]] SurfaceMesh make_divot_plate();

}  // namespace artus::kit
