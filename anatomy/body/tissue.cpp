// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/tissue.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "artus/detail/anatomy/body/bundled_tissues.h"
#include "artus/detail/anatomy/body/tissue_toml.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_fields.h"
#include "artus/detail/core/toml_library.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// dB/cm of amplitude to Np/m.
constexpr double kNeperPerMetre = 100 / kDecibelPerNeper;

constexpr std::array<TomlField<Acoustic>, 6> kAcousticFields{{
    {"speed_of_sound_m_s", &Acoustic::speed_of_sound, 100, 10000, 1, true},
    {"density_kg_m3", &Acoustic::density, 0.1, 25000, 1, true},
    {"attenuation_db_cm_mhz", &Acoustic::attenuation, 0, 100, kNeperPerMetre, true},
    {"attenuation_power", &Acoustic::attenuation_power, 0, 3, 1, false},
    {"backscatter", &Acoustic::backscatter, 0, 100, 1, true},
    {"interface_roughness", &Acoustic::interface_roughness, 0, 1, 1, false},
}};
constexpr std::array<TomlField<Mechanical>, 2> kMechanicalFields{{
    {"youngs_modulus_pa", &Mechanical::youngs_modulus, 0, 1e12, 1, true},
    {"poisson_ratio", &Mechanical::poisson_ratio, 0, 0.4999, 1, false},
}};
constexpr std::array<TomlField<Haptic>, 6> kHapticFields{{
    {"cutting_force_n", &Haptic::cutting_force, 0, 100, 1, true},
    {"wall_stiffness_n_m", &Haptic::wall_stiffness, 1, 1e6, 1, false},
    {"attracted_force_n", &Haptic::attracted_force, 0, 100, 1, false},
    {"friction", &Haptic::friction, 0, 100, 1, false},
    {"clamping_stiffness_n_m", &Haptic::clamping_stiffness, 0, 1e6, 1, false},
    {"puncture_force_n", &Haptic::puncture_force, 0, 100, 1, false},
}};

void read_source(TomlTable& toml, const std::string& group, const std::string& default_source,
                 Tissue& tissue) {
  if (!default_source.empty() && !toml.has("source")) {
    tissue.source[group] = default_source;
    static_cast<void>(toml.text("source"));  // makes the key known
    return;
  }
  tissue.source[group] = toml.required_text("source");
}

void merge_tissue(const std::string& name, const toml::table& table, const std::string& source,
                  bool is_new, Tissue& tissue, Problems& problems) {
  TomlTable groups(table, "tissue '" + name + "'", problems);
  const auto open = [&](const char* group) -> std::optional<TomlTable> {
    const auto* t = groups.table(group);
    if (t != nullptr) return TomlTable(*t, "tissue '" + name + "' " + group, problems);
    if (is_new && !groups.has(group))
      groups.problem("the group [tissue." + name + "." + group + "] is missing");
    return std::nullopt;
  };
  if (auto toml = open("acoustic")) {
    read_fields(*toml, kAcousticFields, tissue.acoustic, is_new);
    read_name(*toml, "kind", kTissueKindNames, tissue.acoustic.kind);
    read_source(*toml, "acoustic", source, tissue);
    toml->finish();
  }
  if (auto toml = open("mechanical")) {
    read_fields(*toml, kMechanicalFields, tissue.mechanical, is_new);
    read_source(*toml, "mechanical", source, tissue);
    toml->finish();
  }
  if (auto toml = open("haptic")) {
    read_fields(*toml, kHapticFields, tissue.haptic, is_new);
    if (const auto hard = toml->boolean("hard")) tissue.haptic.hard = *hard;
    read_name(*toml, "cutting_law", kCuttingLawNames, tissue.haptic.cutting_law);
    read_name(*toml, "prepuncture_law", kPrepunctureLawNames, tissue.haptic.prepuncture_law);
    read_source(*toml, "haptic", source, tissue);
    toml->finish();
  }
  groups.finish();
}

EntryReader into(std::vector<Tissue>& tissues, const std::string& default_source) {
  return [&tissues, default_source](const std::string& name, const toml::table& table,
                                    Problems& problems) {
    auto at = std::find_if(tissues.begin(), tissues.end(),
                           [&name](const Tissue& t) { return t.name == name; });
    const bool is_new = at == tissues.end();
    if (is_new) at = tissues.insert(tissues.end(), Tissue{name, {}, {}, {}, {}});
    merge_tissue(name, table, default_source, is_new, *at, problems);
  };
}

}  // namespace

void merge_tissues(const toml::table& table, const std::string& default_source,
                   std::vector<Tissue>& tissues, Problems& problems) {
  read_entries(table, "tissue", problems, into(tissues, default_source));
}

Result<std::vector<Tissue>> parse_tissues(std::string_view text, const std::string& name) {
  std::vector<Tissue> tissues;
  ARTUS_TRY(parse_library(text, name, "tissue", into(tissues, {})));
  return tissues;
}

Result<std::vector<Tissue>> read_tissues(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse_tissues(*bytes, file.string());
}

Result<std::vector<Tissue>> read_bundled_tissues() {
  return parse_tissues(kBundledTissues, "bundled tissue library");
}

}  // namespace artus
