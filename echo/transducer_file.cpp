// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/transducer_file.h"

#include <array>
#include <cmath>

#include "artus/core/text_file.h"
#include "artus/core/toml_table.h"
#include "artus/core/units.h"
#include "artus/echo/bundled_transducers.h"
#include "artus/echo/setting_ranges.h"

namespace artus {
namespace {

/// A number of the file: its key, where it goes, its range, the factor to SI.
struct Field {
  const char* key;
  double Transducer::*member;
  Range range;
  double to_si;
  bool required;
};

using Ranges = TransducerRanges;

constexpr std::array<Field, 11> kFields{{
    {"width_mm", &Transducer::width, Ranges::width, kMillimetre, true},
    {"radius_mm", &Transducer::radius, {0, Ranges::radius.high}, kMillimetre, false},
    {"steering_deg", &Transducer::steering, Ranges::steering, kDegree, false},
    {"frequency_mhz", &Transducer::frequency, Ranges::frequency, 1e6, true},
    {"bandwidth", &Transducer::bandwidth, Ranges::bandwidth, 1, true},
    {"pulse_cycles", &Transducer::pulse_cycles, Ranges::pulse_cycles, 1, true},
    {"f_number", &Transducer::f_number, Ranges::f_number, 1, true},
    {"max_aperture_mm", &Transducer::max_aperture, Ranges::max_aperture, kMillimetre, true},
    {"elevation_height_mm", &Transducer::elevation_height, Ranges::elevation_height, kMillimetre,
     true},
    {"elevation_focus_mm", &Transducer::elevation_focus, Ranges::elevation_focus, kMillimetre,
     true},
    {"transmit_focus_mm",
     &Transducer::transmit_focus,
     {0, Ranges::transmit_focus.high},
     kMillimetre,
     false},
}};

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
  for (const Field& field : kFields) {
    double& value = preset.transducer.*field.member;
    const Range range = in_unit(field.range, field.to_si);
    // The range is in the file's unit, so that is what the message tells; scaled afterwards.
    if (field.required) {
      value = toml.required_number(field.key, range.low, range.high) * field.to_si;
    } else if (const auto given = toml.number(field.key, range.low, range.high)) {
      value = *given * field.to_si;
    }
  }
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
  std::string names;
  for (const TransducerPreset& preset : *presets) {
    if (preset.name == name_or_file) return preset;
    names += (names.empty() ? "" : ", ") + preset.name;
  }
  return fail(ErrorCode::not_found, "no transducer '" + name_or_file + "'; there are " + names +
                                        ", or give a .toml file");
}

}  // namespace artus
