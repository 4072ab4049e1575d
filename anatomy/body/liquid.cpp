// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/liquid.h"

#include <cmath>

#include "artus/detail/anatomy/body/bundled_fluids.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_library.h"

namespace artus {
namespace {

constexpr std::string_view kInjected = "injected_";

constexpr double kMilli = 1e-3;
constexpr double kMicro = 1e-6;

Liquid read_liquid(const std::string& name, const toml::table& table, Problems& problems) {
  TomlTable toml(table, "liquid '" + name + "'", problems);
  Liquid liquid;
  liquid.name = name;
  Viscosity& v = liquid.viscosity;
  v.zero = toml.required_number("viscosity_mpa_s", 1e-3, 1e9, kMilli);
  v.infinite = toml.number("viscosity_infinite_mpa_s", 1e-3, 1e6, kMilli).value_or(v.zero);
  v.relaxation = toml.number("relaxation_s", 0, 1e6).value_or(0);
  v.power = toml.number("power", 0.05, 1).value_or(1);
  if (v.infinite > v.zero)
    toml.problem_at("viscosity_infinite_mpa_s", "must not be above 'viscosity_mpa_s'");
  if (!v.newtonian() && (!(v.relaxation > 0) || !toml.has("power")))
    toml.problem("a liquid that thins needs 'relaxation_s' above 0 and 'power'");
  liquid.density = toml.required_number("density_kg_m3", 0.1, 25000);
  liquid.tissue = toml.required_text("tissue");
  liquid.backscatter = toml.number("backscatter", 0, 100).value_or(0);
  liquid.solids = toml.number("solids", 0, 0.6).value_or(0);
  liquid.grain_radius = toml.number("grain_radius_um", 0, 1000, kMicro).value_or(0);
  liquid.source = toml.required_text("source");
  toml.finish();
  return liquid;
}

}  // namespace

double Viscosity::at(double rate) const noexcept {
  if (newtonian()) return zero;
  const double x = relaxation * rate;
  return infinite + (zero - infinite) * std::pow(1 + x * x, (power - 1) / 2);
}

Result<std::vector<Liquid>> parse_liquids(std::string_view text, const std::string& name) {
  std::vector<Liquid> liquids;
  ARTUS_TRY(
      parse_library(text, name, "liquid",
                    [&](const std::string& entry, const toml::table& table, Problems& problems) {
                      liquids.push_back(read_liquid(entry, table, problems));
                    }));
  return liquids;
}

Result<std::vector<Liquid>> read_liquids(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse_liquids(*bytes, file.string());
}

Result<std::vector<Liquid>> read_bundled_liquids() {
  return parse_liquids(kBundledLiquids, "bundled liquids");
}

std::string injected_tissue_name(const Liquid& liquid) {
  return std::string(kInjected) + liquid.name;
}

bool is_injected(std::string_view tissue_name) noexcept {
  return tissue_name.starts_with(kInjected);
}

Result<Liquid> find_liquid(std::span<const Liquid> liquids, std::string_view name) {
  const auto at = find_name(item_names(liquids), name, "liquid");
  ARTUS_TRY(at);
  return liquids[*at];
}

}  // namespace artus
