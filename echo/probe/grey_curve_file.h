// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/echo/image_settings.h"

namespace artus {

/// A grey curve as a file describes it (devices/grey-curves, docs/echography.md).
struct GreyCurvePreset {
  std::string name;    ///< [a-z0-9-]+
  std::string title;   ///< one line for people
  std::string source;  ///< where the values come from, or "assumed: why"
  GreyCurve curve;
};

/// Parses a curve; `file` stands in messages. Errors: malformed (with line), invalid (unknown key,
/// missing value, other than nine numbers that rise from 0..1), every problem in one message.
[[nodiscard]] Result<GreyCurvePreset> parse_grey_curve(std::string_view text,
                                                       const std::string& file);

/// The curves that come with artus (built in), the default first.
[[nodiscard]] Result<std::vector<GreyCurvePreset>> read_bundled_grey_curves();

/// The bundled curve of this name, or the file when `name_or_file` ends in ".toml".
/// Errors: as parse_grey_curve, and not_found, unreadable; not_found lists the names there are.
[[nodiscard]] Result<GreyCurvePreset> find_grey_curve(const std::string& name_or_file);

}  // namespace artus
