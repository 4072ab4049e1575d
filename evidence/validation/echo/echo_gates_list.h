// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/evidence/validation/echo/echo_gates.h"

/// The gates themselves, one function each; echo_gates.h runs them by name. "Reference" is the wave
/// model or the literature that docs/echography.md names for each bound.
namespace artus {

/// Envelope statistics of a homogeneous block against fully developed speckle.
[[nodiscard]] EchoGate gate_speckle();
/// Width of point targets beside the axis against 0.97 wavelengths times the F-number.
[[nodiscard]] EchoGate gate_lateral_width();
/// Width of point targets across the plane against the wave model, by element height and depth.
[[nodiscard]] EchoGate gate_slice_width();
/// Fall of the speckle with depth against twice the attenuation.
[[nodiscard]] EchoGate gate_attenuation();
/// Two tissues of one impedance: no echo between them.
[[nodiscard]] EchoGate gate_matched_impedance();
/// Echo levels of tissue pairs against their impedance step.
[[nodiscard]] EchoGate gate_interfaces();
/// A layer of fat shifts what lies below it.
[[nodiscard]] EchoGate gate_fat_shift();
/// A layer of fluid brightens what lies below it.
[[nodiscard]] EchoGate gate_enhancement();
/// Tendon against muscle by the beam's tilt.
[[nodiscard]] EchoGate gate_tendon();
/// Spacing of the lines below a 22 G needle.
[[nodiscard]] EchoGate gate_needle_rings();
/// Brightness of a needle by its angle to the face.
[[nodiscard]] EchoGate gate_needle_angle();
/// Brightness of a needle beside the plane.
[[nodiscard]] EchoGate gate_needle_offset();
/// Rigid motion, sideways motion, thread count.
[[nodiscard]] EchoGate gate_motion();

}  // namespace artus
