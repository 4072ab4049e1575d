// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/material.h"

#include <algorithm>
#include <array>

#include "artus/core/check.h"

namespace artus {
namespace {

/// A tissue without stiffness of its own (fluid) keeps its shape a little, or nothing holds it.
constexpr double kLeastShear = 100;  // Pa; assumed: far below any solid tissue

/// All tissues are water: the softest must not be squeezed out of existence by a probe's 10 kPa.
constexpr double kLeastBulk = 50e3;  // Pa; assumed: a fifth of volume at 10 kPa at most

constexpr std::array<SoftTissue, 16> kTissues{{
    {"fluid", kLeastShear, 0, 0, "assumed: flows"},
    {"skin", 40e3, 0, 0, "assumed: 120 kPa in tension, order of magnitude of in-vivo suction"},
    {"fat", 0.8e3, 2.4, 0,
     "[AdiposeMre2023] shear modulus at rest and its growth with compression; b fitted to that "
     "growth at 30 %"},
    {"fascia", 100e3, 0, 1e6, "assumed: a thin dense sheet, soft across"},
    {"muscle", 2.5e3, 0.75, 5e3,
     "[AdiposeMre2023] growth with compression; assumed: modulus at rest between its 1 kPa and "
     "the "
     "3.9 to 6.2 kPa of [ThighMre2015]; along the fibres three times as stiff"},
    {"tendon", 35e3, 4, 1e6,
     "[Main2011] across the fibres 25 to 39 kPa; assumed: along, cut down from 500 MPa to what "
     "the "
     "cage can tell from rigid"},
    {"ligament", 100e3, 0, 1e6, "assumed: slack at small strain"},
    {"capsule", 150e3, 0, 0, "assumed: facet capsule's 0.13 to 0.4 MPa at 10 % strain"},
    {"bursa", 200, 0, 0, "assumed: a film that carries pressure, hardly shear"},
    {"synovial_fluid", kLeastShear, 0, 0, "assumed: flows"},
    {"cartilage", 0.27e6, 0, 0, "assumed: 0.8 MPa at equilibrium"},
    {"labrum", 0.4e6, 0, 0, "assumed: between capsule and cartilage"},
    {"nerve", 13e3, 2, 0.5e6, "[Main2011] across the fibres 12.9 kPa; assumed: along"},
    {"blood", kLeastShear, 0, 0, "assumed: flows"},
    {"artery", 30e3, 0, 0, "assumed: wall and blood as one, held open by 13 kPa"},
    {"vein", 500, 0, 0, "assumed: wall and blood as one, closes under 1 to 2 kPa"},
}};

}  // namespace

std::span<const SoftTissue> soft_tissues() noexcept {
  return kTissues;
}

double lame_lambda(double shear, double poisson_ratio) {
  ARTUS_REQUIRE(poisson_ratio >= 0 && poisson_ratio < 0.5, "a Poisson ratio from 0 to below 0.5");
  return 2 * shear * poisson_ratio / (1 - 2 * poisson_ratio);
}

SoftMaterial make_soft_material(const Tissue& tissue, const Vec3& fibre, double poisson_ratio) {
  SoftMaterial m;
  m.hard = tissue.haptic.hard;
  const auto known = soft_tissues();
  const auto row = std::find_if(known.begin(), known.end(),
                                [&](const SoftTissue& t) { return t.tissue == tissue.name; });
  if (row != known.end()) {
    m.shear = row->shear;
    m.hardening = row->hardening;
    if (fibre.squaredNorm() > 0) m.fibre_modulus = row->fibre_modulus;
  } else {
    m.shear = std::max(kLeastShear, tissue.mechanical.youngs_modulus / 3);
  }
  m.fibre = fibre;
  m.bulk = std::max(kLeastBulk, lame_lambda(m.shear, poisson_ratio));
  return m;
}

}  // namespace artus
