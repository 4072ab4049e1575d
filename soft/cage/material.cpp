// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/material.h"

#include <algorithm>
#include <array>

#include "artus/detail/core/check.h"
#include "artus/detail/core/toml_fields.h"
#include "artus/detail/core/toml_library.h"
#include "artus/detail/soft/cage/bundled_soft_tissues.h"

namespace artus {
namespace {

/// A tissue without stiffness of its own (fluid) keeps its shape a little, or nothing holds it.
constexpr double kMinShear = 100;  // Pa; assumed: far below any solid tissue

/// All tissues are water: the softest must not be squeezed out of existence by a probe's 10 kPa.
constexpr double kMinBulk = 50e3;  // Pa; assumed: a fifth of volume at 10 kPa at most

/// What blood and fluid may leave of a tissue that is pressed; beyond, it is water.
constexpr double kFirmFrom = 0.1;  // of its volume; assumed: a few per cent, and twice that

// Below 1 Pa nothing holds a cube; above 1 GPa it is hard, and told so by the tissue library.
constexpr std::array<TomlField<SoftTissue>, 4> kFields{{
    {"shear_pa", &SoftTissue::shear, 1, 1e9, 1, true},
    {"hardening", &SoftTissue::hardening, 0, 20, 1, false},
    {"fibre_modulus_pa", &SoftTissue::fibre_modulus, 0, 1e9, 1, false},
    {"drain_pa", &SoftTissue::drain_pressure, 0, 1e6, 1, false},
}};

SoftTissue read_row(const std::string& name, const toml::table& table, Problems& problems) {
  TomlTable toml(table, "soft tissue '" + name + "'", problems);
  SoftTissue row;
  row.tissue = name;
  read_fields(toml, kFields, row);
  row.source = toml.required_text("source");
  toml.finish();
  return row;
}

}  // namespace

Result<std::vector<SoftTissue>> parse_soft_tissues(std::string_view text, const std::string& name) {
  std::vector<SoftTissue> rows;
  ARTUS_TRY(parse_library(
      text, name, "soft",
      [&rows](const std::string& entry, const toml::table& table, Problems& problems) {
        rows.push_back(read_row(entry, table, problems));
      }));
  return rows;
}

Result<std::vector<SoftTissue>> read_bundled_soft_tissues() {
  return parse_soft_tissues(kBundledSoftTissues, "bundled soft tissues");
}

double lame_lambda(double shear, double poisson_ratio) {
  ARTUS_REQUIRE(poisson_ratio >= 0 && poisson_ratio < 0.5, "a Poisson ratio from 0 to below 0.5");
  return 2 * shear * poisson_ratio / (1 - 2 * poisson_ratio);
}

SoftMaterial make_soft_material(const Tissue& tissue, std::span<const SoftTissue> values,
                                const Vec3& fibre, double poisson_ratio) {
  SoftMaterial m;
  m.hard = tissue.haptic.hard;
  const auto row = std::find_if(values.begin(), values.end(),
                                [&](const SoftTissue& t) { return t.tissue == tissue.name; });
  if (row != values.end()) {
    m.shear = row->shear;
    m.hardening = row->hardening;
    m.drain_pressure = row->drain_pressure;
    if (fibre.squaredNorm() > 0) m.fibre_modulus = row->fibre_modulus;
  } else {
    m.shear = std::max(kMinShear, tissue.mechanical.youngs_modulus / 3);
  }
  m.fibre = fibre;
  m.bulk = std::max(kMinBulk, lame_lambda(m.shear, poisson_ratio));
  if (!m.hard) m.firm_from = kFirmFrom;
  return m;
}

}  // namespace artus
