// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/transducer_file.h"

#include <array>
#include <cmath>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_fields.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/probe/bundled_transducers.h"
#include "artus/detail/echo/probe/setting_ranges.h"

namespace artus {
namespace {

/// A number of the file; `range` is in SI as the engine has it.
TomlField<Transducer> field(const char* key, double Transducer::*member, Range range, double to_si,
                            bool required) {
  const Range in_file = in_unit(range, to_si);
  return {key, member, in_file.low, in_file.high, to_si, required};
}

using Ranges = TransducerRanges;

std::array<TomlField<Transducer>, 11> fields_of_file() {
  return {
      field("width_mm", &Transducer::width, Ranges::width, kMillimetre, true),
      field("radius_mm", &Transducer::radius, {0, Ranges::radius.high}, kMillimetre, false),
      field("steering_deg", &Transducer::steering, Ranges::steering, kDegree, false),
      field("frequency_mhz", &Transducer::frequency, Ranges::frequency, 1e6, true),
      field("bandwidth", &Transducer::bandwidth, Ranges::bandwidth, 1, true),
      field("pulse_cycles", &Transducer::pulse_cycles, Ranges::pulse_cycles, 1, true),
      field("f_number", &Transducer::f_number, Ranges::f_number, 1, true),
      field("max_aperture_mm", &Transducer::max_aperture, Ranges::max_aperture, kMillimetre, true),
      field("elevation_height_mm", &Transducer::elevation_height, Ranges::elevation_height,
            kMillimetre, true),
      field("elevation_focus_mm", &Transducer::elevation_focus, Ranges::elevation_focus,
            kMillimetre, true),
      field("transmit_focus_mm", &Transducer::transmit_focus, {0, Ranges::transmit_focus.high},
            kMillimetre, false),
  };
}

}  // namespace

Result<TransducerPreset> parse_transducer(std::string_view text, const std::string& file) {
  const auto document = parse_toml(text, file);
  ARTUS_TRY(document);
  Problems problems;
  TomlTable toml(*document, "transducer", problems);
  TransducerPreset preset;
  static_cast<void>(toml.required_number("format", 1, 1));
  preset.name = toml.required_text("name");
  if (!preset.name.empty() && !is_plain_name(preset.name, '-'))
    toml.problem_at("name", "must be made of [a-z0-9-]");
  preset.title = toml.required_text("title");
  preset.source = toml.required_text("source");
  read_fields(toml, fields_of_file(), preset.transducer);
  const double lines = toml.required_number("lines", Ranges::n_lines.low, Ranges::n_lines.high);
  if (lines != std::floor(lines)) toml.problem_at("lines", "must be a whole number");
  preset.transducer.n_lines = static_cast<int>(lines);
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, file);
  if (const auto valid = validate(preset.transducer); !valid)
    return fail(ErrorCode::invalid, valid.error().message, file);
  return preset;
}

Result<TransducerPreset> read_transducer(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse_transducer(*bytes, file.string());
}

Result<std::vector<TransducerPreset>> read_bundled_transducers() {
  std::vector<TransducerPreset> presets;
  for (const std::string_view text : bundled_transducers()) {
    auto preset =
        parse_transducer(text, "bundled transducer " + std::to_string(presets.size() + 1));
    ARTUS_TRY(preset);
    presets.push_back(std::move(*preset));
  }
  return presets;
}

Result<TransducerPreset> find_transducer(const std::string& name_or_file) {
  if (std::filesystem::path(name_or_file).extension() == ".toml")
    return read_transducer(name_or_file);
  const auto presets = read_bundled_transducers();
  ARTUS_TRY(presets);
  const auto at = find_name(item_names(*presets), name_or_file, "transducer");
  if (!at) return fail(at.error().code, at.error().message + ", or give a .toml file");
  return presets->at(*at);
}

}  // namespace artus
