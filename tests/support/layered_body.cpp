// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/layered_body.h"

#include "artus/detail/core/units.h"

namespace artus::test {
namespace {

constexpr double per_metre(double decibel_per_cm) {
  return decibel_per_cm * 100 / kDecibelPerNeper;
}

Tissue make_tissue(const std::string& name, const Acoustic& acoustic, double youngs_modulus,
                   const Haptic& haptic) {
  Tissue tissue;
  tissue.name = name;
  tissue.acoustic = acoustic;
  tissue.mechanical.youngs_modulus = youngs_modulus;
  tissue.haptic = haptic;
  for (const char* group : {"acoustic", "mechanical", "haptic"}) {
    tissue.source[group] = "assumed: test value";
  }
  return tissue;
}

Haptic haptic_of(double cutting_force, bool hard = false) {
  Haptic haptic;
  haptic.cutting_force = cutting_force;
  haptic.attracted_force = 0.25 * cutting_force;
  haptic.friction = cutting_force > 0 ? 1 : 0;
  haptic.clamping_stiffness = 100 * cutting_force;
  haptic.hard = hard;
  if (hard) haptic.wall_stiffness = 4000;  // as the tissue library has bone
  return haptic;
}

}  // namespace

std::vector<Tissue> make_test_tissues() {
  return {
      make_tissue("gel", {1490, 1000, per_metre(0.002), 2, 0, 0, TissueKind::fluid}, 1e3,
                  haptic_of(0)),
      make_tissue("skin", {1655, 1131, per_metre(0.35), 1, 1.5, 0.6, TissueKind::skin}, 1e5,
                  haptic_of(1)),
      make_tissue("fat", {1462, 927, per_metre(0.4), 1.1, 0.8, 0.5, TissueKind::fat}, 3e3,
                  haptic_of(0.8)),
      make_tissue("muscle", {1562, 1058, per_metre(0.75), 1, 1, 0.5, TissueKind::muscle}, 15e3,
                  haptic_of(2)),
      make_tissue("bursa", {1520, 1005, per_metre(0.02), 1, 0, 0.2, TissueKind::fluid}, 1e3,
                  haptic_of(1.5)),
      make_tissue("tendon", {1827, 1121, per_metre(1.5), 1, 2, 0.3, TissueKind::tendon}, 1e8,
                  haptic_of(2.5)),
      make_tissue("cartilage", {1626, 1066, per_metre(5), 1, 0.1, 0.2}, 1e6, haptic_of(3)),
      make_tissue("bone", {3194, 1862, per_metre(8.5), 1, 0.3, 0.2, TissueKind::bone}, 1e10,
                  haptic_of(4, true)),
  };
}

}  // namespace artus::test
