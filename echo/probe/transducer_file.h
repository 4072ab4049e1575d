// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/echo/transducer.h"

namespace artus {

/// A probe as a file describes it (devices/transducers, docs/echography.md).
struct TransducerPreset {
  std::string name;    ///< [a-z0-9-]+
  std::string title;   ///< one line for people
  std::string source;  ///< where the values come from, or "assumed: why"
  Transducer transducer;
};

/// Parses a preset; `file` stands in messages. Errors: malformed (with line), invalid (unknown key,
/// missing value, value out of its range), every problem in one message.
[[nodiscard]] Result<TransducerPreset> parse_transducer(std::string_view text,
                                                        const std::string& file);

/// The same from a file. Errors: as parse_transducer, and not_found, unreadable.
[[nodiscard]] Result<TransducerPreset> read_transducer(const std::filesystem::path& file);

/// The presets that come with artus (built in), the default first.
[[nodiscard]] Result<std::vector<TransducerPreset>> read_bundled_transducers();

/// The bundled preset of this name, or the file when `name_or_file` ends in ".toml".
/// Errors: as read_transducer; not_found lists the names there are.
[[nodiscard]] Result<TransducerPreset> find_transducer(const std::string& name_or_file);

}  // namespace artus
