// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/body/tissue.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "artus/anatomy/body/bundled_tissues.h"
#include "artus/anatomy/body/tissue_toml.h"
#include "artus/core/text_file.h"
#include "artus/core/units.h"

namespace artus {
namespace {

/// dB/cm of amplitude to Np/m.
constexpr double kNeperPerMetre = 100 / kDecibelPerNeper;

/// One number of a group: its key, its physical range, and the factor to SI.
template <class Group>
struct Field {
  const char* key;
  double Group::*member;
  double low;
  double high;
  double to_si;
  bool required;
};

constexpr std::array<Field<Acoustic>, 6> kAcousticFields{{
    {"speed_of_sound_m_s", &Acoustic::speed_of_sound, 100, 10000, 1, true},
    {"density_kg_m3", &Acoustic::density, 0.1, 25000, 1, true},
    {"attenuation_db_cm_mhz", &Acoustic::attenuation, 0, 100, kNeperPerMetre, true},
    {"attenuation_power", &Acoustic::attenuation_power, 0, 3, 1, false},
    {"backscatter", &Acoustic::backscatter, 0, 100, 1, true},
    {"interface_roughness", &Acoustic::interface_roughness, 0, 1, 1, false},
}};
constexpr std::array<Field<Mechanical>, 2> kMechanicalFields{{
    {"youngs_modulus_pa", &Mechanical::youngs_modulus, 0, 1e12, 1, true},
    {"poisson_ratio", &Mechanical::poisson_ratio, 0, 0.4999, 1, false},
}};
constexpr std::array<Field<Haptic>, 6> kHapticFields{{
    {"cutting_force_n", &Haptic::cutting_force, 0, 100, 1, true},
    {"wall_stiffness_n_m", &Haptic::wall_stiffness, 1, 1e6, 1, false},
    {"attracted_force_n", &Haptic::attracted_force, 0, 100, 1, false},
    {"friction", &Haptic::friction, 0, 100, 1, false},
    {"clamping_stiffness_n_m", &Haptic::clamping_stiffness, 0, 1e6, 1, false},
    {"puncture_force_n", &Haptic::puncture_force, 0, 100, 1, false},
}};

template <class Group, std::size_t n>
void read_fields(TomlTable& toml, const std::array<Field<Group>, n>& fields, bool is_new,
                 Group& group) {
  for (const auto& f : fields) {
    if (is_new && f.required && !toml.has(f.key))
      toml.problem("'" + std::string(f.key) + "' is missing");
    // The range is in the file's unit, so that is what the message tells; scaled afterwards.
    if (const auto value = toml.number(f.key, f.low, f.high)) group.*f.member = *value * f.to_si;
  }
}

/// One of a row of names, as the value of that place in the row.
template <class Value, std::size_t n>
void read_name(TomlTable& toml, const char* key, const std::array<std::string_view, n>& names,
               Value& value) {
  const auto name = toml.text(key);
  if (!name) return;
  const auto at = std::find(names.begin(), names.end(), *name);
  if (at != names.end()) {
    value = static_cast<Value>(at - names.begin());
    return;
  }
  std::string known;
  for (const std::string_view other : names)
    known += (known.empty() ? "" : ", ") + std::string(other);
  toml.problem(std::string(key) + " is '" + *name + "', must be one of " + known);
}

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
    read_fields(*toml, kAcousticFields, is_new, tissue.acoustic);
    read_name(*toml, "kind", kTissueKindNames, tissue.acoustic.kind);
    read_source(*toml, "acoustic", source, tissue);
    toml->finish();
  }
  if (auto toml = open("mechanical")) {
    read_fields(*toml, kMechanicalFields, is_new, tissue.mechanical);
    read_source(*toml, "mechanical", source, tissue);
    toml->finish();
  }
  if (auto toml = open("haptic")) {
    read_fields(*toml, kHapticFields, is_new, tissue.haptic);
    if (const auto hard = toml->boolean("hard")) tissue.haptic.hard = *hard;
    read_name(*toml, "cutting_law", kCuttingLawNames, tissue.haptic.cutting_law);
    read_name(*toml, "prepuncture_law", kPrepunctureLawNames, tissue.haptic.prepuncture_law);
    read_source(*toml, "haptic", source, tissue);
    toml->finish();
  }
  groups.finish();
}

/// The entries of a table in the order of the file (toml++ keeps them by name).
std::vector<std::pair<std::string, const toml::node*>> in_file_order(const toml::table& table) {
  std::vector<std::pair<std::string, const toml::node*>> entries;
  std::vector<toml::source_position> places;
  for (const auto& [key, node] : table) {
    const auto at = key.source().begin;
    const auto place = std::upper_bound(places.begin(), places.end(), at);
    entries.emplace(entries.begin() + (place - places.begin()), std::string(key.str()), &node);
    places.insert(place, at);
  }
  return entries;
}

}  // namespace

void merge_tissues(const toml::table& table, const std::string& default_source,
                   std::vector<Tissue>& tissues, Problems& problems) {
  for (const auto& [name, node] : in_file_order(table)) {
    if (!node->is_table() || !is_plain_name(name, '_')) {
      problems.add(*node, "[tissue." + name + "] must be a table with a name of [a-z0-9_]");
      continue;
    }
    auto at = std::find_if(tissues.begin(), tissues.end(),
                           [&n = name](const Tissue& t) { return t.name == n; });
    const bool is_new = at == tissues.end();
    if (is_new) at = tissues.insert(tissues.end(), Tissue{name, {}, {}, {}, {}});
    merge_tissue(name, *node->as_table(), default_source, is_new, *at, problems);
  }
}

Result<std::vector<Tissue>> parse_tissues(std::string_view text, const std::string& name) {
  const auto document = parse_toml(text, name);
  ARTUS_TRY(document);
  Problems problems;
  TomlTable toml(*document, "tissue library", problems);
  if (toml.required_number("format", 1, 1) == 0) toml.problem("this build reads format = 1");
  std::vector<Tissue> tissues;
  if (const auto* table = toml.table("tissue")) {
    merge_tissues(*table, {}, tissues, problems);
  } else {
    toml.problem("there is no tissue in it ([tissue.NAME.acoustic] and so on)");
  }
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
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
