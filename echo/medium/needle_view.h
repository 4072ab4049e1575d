// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/core/geometry.h"

namespace artus {

/// The needle as sound meets it: a steel tube with a bore.
struct NeedleShape {
  double outer_diameter = 0.717e-3;  ///< m
  double bore = 0.413e-3;            ///< m
  double length = 35e-3;             ///< m, hub to tip; that of the forces (ContactParams)
  bool echogenic = false;            ///< dimpled shaft that scatters back at steep angles, too
};

/// Dimensions of a hypodermic gauge, 18 to 23, 25 or 27; empty for any other.
/// assumed: nominal catalogue values.
[[nodiscard]] std::optional<NeedleShape> needle_of_gauge(int gauge);

/// A needle in the body: X_JN has its origin at the tip and z from hub to tip.
struct NeedleView {
  Pose X_JN = Pose::Identity();
  NeedleShape shape;
  Vec3 v_JN = Vec3::Zero();  ///< m/s in frame J; only colour Doppler looks at it
};

/// What a needle left behind when it was withdrawn: a thin line of cut tissue and small bubbles.
struct NeedleTrack {
  Vec3 p_JEntry = Vec3::Zero();  ///< m
  Vec3 p_JTip = Vec3::Zero();    ///< m, the deepest point
  /// rms echo amplitude, mirror = 1. assumed: 8 dB above muscle's speckle; let it fade with time.
  double amplitude = 0.025;
};

/// Spacing on screen of the lines below a needle seen from the side: one trip through wall, bore
/// and wall, shown at the display's speed of sound, m.
[[nodiscard]] double reverberation_pitch(const NeedleShape& shape) noexcept;

/// Echo amplitude of a needle at angle `angle` (rad) between its axis and the probe's face, mirror
/// = 1. Its surface is made of small mirrors whose slopes along the shaft are spread exponentially;
/// each returns what the aperture catches of it, `specular_phase` (of the transducer). Within the
/// aperture's lobe the law is flat, beyond it dB, and so grey, fall in proportion to the angle, as
/// measured from 0 to 65 degrees [SchafhalterZoppoth2004]. assumed: the spread of slopes, 5.7
/// degrees plain and 13 dimpled, which gives the values at 75 degrees of [Nichols2003].
[[nodiscard]] double needle_reflectivity(const NeedleShape& shape, double angle,
                                         double specular_phase) noexcept;

/// The same as scanners show it, for looks other than raw: a narrow peak on a plateau. A plain
/// shaft has the contrasts that were measured on screens at 10 to 50 degrees, read back through the
/// default grey curve at the default gain [VanDeBerg2019]; a dimpled one has the value of
/// [Nichols2003] at 75 degrees, and in between a straight line (assumed).
[[nodiscard]] double needle_on_screen(const NeedleShape& shape, double angle) noexcept;

}  // namespace artus
