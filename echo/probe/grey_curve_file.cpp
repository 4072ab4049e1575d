// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/probe/grey_curve_file.h"

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/echo/probe/bundled_grey_curves.h"

namespace artus {
namespace {

void read_knots(TomlTable& toml, GreyCurve& curve) {
  const toml::array* knots = toml.array("grey");
  if (knots == nullptr) return toml.problem("'grey' is missing: nine numbers from 0 to 1");
  if (knots->size() != GreyCurve::kKnots)
    return toml.problem_at("grey", "must be nine numbers, one for each eighth of the range");
  double least = 0;
  for (std::size_t k = 0; k < GreyCurve::kKnots; ++k) {
    const auto grey = (*knots)[k].value<double>();
    if (!grey || !(*grey >= least) || !(*grey <= 1))
      return toml.problem_at("grey", "must be numbers from 0 to 1 that never fall");
    curve.grey[k] = least = *grey;
  }
}

}  // namespace

Result<GreyCurvePreset> parse_grey_curve(std::string_view text, const std::string& file) {
  const auto document = parse_toml(text, file);
  ARTUS_TRY(document);
  Problems problems;
  TomlTable toml(*document, "grey curve", problems);
  GreyCurvePreset preset;
  static_cast<void>(toml.required_number("format", 1, 1));
  preset.name = toml.required_text("name");
  if (!preset.name.empty() && !is_plain_name(preset.name, '-'))
    toml.problem_at("name", "must be made of [a-z0-9-]");
  preset.title = toml.required_text("title");
  preset.source = toml.required_text("source");
  read_knots(toml, preset.curve);
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, file);
  return preset;
}

Result<std::vector<GreyCurvePreset>> read_bundled_grey_curves() {
  std::vector<GreyCurvePreset> presets;
  for (const std::string_view text : bundled_grey_curves()) {
    auto preset =
        parse_grey_curve(text, "bundled grey curve " + std::to_string(presets.size() + 1));
    ARTUS_TRY(preset);
    presets.push_back(std::move(*preset));
  }
  return presets;
}

Result<GreyCurvePreset> find_grey_curve(const std::string& name_or_file) {
  if (std::filesystem::path(name_or_file).extension() == ".toml") {
    const auto bytes = read_bytes(name_or_file);
    ARTUS_TRY(bytes);
    return parse_grey_curve(*bytes, name_or_file);
  }
  const auto presets = read_bundled_grey_curves();
  ARTUS_TRY(presets);
  const auto at = find_name(item_names(*presets), name_or_file, "grey curve");
  if (!at) return fail(at.error().code, at.error().message + ", or give a .toml file");
  return presets->at(*at);
}

}  // namespace artus
