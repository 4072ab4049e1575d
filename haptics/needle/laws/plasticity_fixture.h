// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

/// Parameters of the plasticity-type virtual fixture; all assumed (the source gives none): they
/// hold as firmly as clamping does in muscle and yield before a desktop device saturates.
struct PlasticityParams {
  double stiffness = 200;  ///< N/m, K
  double damping = 1;      ///< N s/m, B
  double yield_force = 3;  ///< N, F: above it the fixture gives way and keeps the new place
};

/// A bilateral fixture on the insertion line by impedance-type plasticity: like dry friction with a
/// spring, it holds the tip on the line up to F and then lets it slip. Source [Kikuuwe2007] by
/// [Alamilla2020] eqs. 2.11-2.13, on the lateral offset as a vector. The thesis prints k = M / T^2,
/// which belongs to the admittance type: with the impedance type's p* the force is K (q - p) plus
/// B times the difference of velocities only for k = K + B / T. M / T^2 would also be 1e5 N/m for
/// 0.1 kg at 1 kHz, a hundred times that at 10 kHz. So k = K + B / T here.
class PlasticityFixture {
 public:
  explicit PlasticityFixture(const PlasticityParams& params = {}) noexcept : params_(params) {}
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;
  /// The line moved; the place held goes with it, less what it was off the line but for `kept`.
  ARTUS_REALTIME void take_line(double kept) noexcept;

 private:
  PlasticityParams params_;
  Vec3 place_ = Vec3::Zero();     // q, lateral, m
  Vec3 last_tip_ = Vec3::Zero();  // m
  bool begun_ = false;
};

}  // namespace artus
