// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

#include "artus/detail/soft/liquid/injected_body.h"

namespace artus {

/// Opens ellipsoids of liquid in a body, one after another, as region `number` of it. Every ray
/// from an ellipsoid's middle, in its own measure, is mapped onto itself by
///   rho^3 -> f s^3 + rho^3 (1 - f s^3 / d^3),   s^3 = a^3 / (1 + (a / q d)^3),
/// where bone lies at d: the liquid's surface is at s, what is at the middle comes to just outside
/// of it (f = 1.1: a film of tissue for facets to differ in), bone stays, and what is between is
/// pressed together evenly. Where there is no bone that is rho^3 + f a^3, which keeps every volume
/// but the film's. As each ray is mapped upward nothing passes anything. Close to bone the liquid
/// is flatter (q = 0.8 of the way at most) and goes as much farther elsewhere; a ragged one has an
/// `a` of each direction's own. assumed: the form.
class BolusOpening {
 public:
  /// Requires: `body` outlives it; it has the region `number`.
  BolusOpening(CompiledJoint& body, RegionId number);

  /// `later`: those that are to be opened after it, whose middles are taken along. All liquid
  /// together has the volume of all that was opened, to 1e-15 m^3, wherever bone leaves room for
  /// it.
  void open(const Bolus& bolus, std::span<Bolus> later);
  /// Whether a point, m, frame J, lies in what was opened.
  [[nodiscard]] bool is_liquid(const Vec3& p) const;

 private:
  [[nodiscard]] std::vector<bool> find_bone() const;

  CompiledJoint& body_;
  RegionId number_;
  double wanted_ = 0;  // m^3 of all so far
};

}  // namespace artus
