// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/viewer/window.h"

namespace artus {

/// --width, --height, --window-rate, --font-scale, --language, --keys, --left-handed: how a window
/// looks and listens.
void add_window_options(Command* command, WindowOptions& window, std::string& language);

/// --language: en or fr.
void add_language_option(Command* command, std::string& language);
/// The flag, or what the system says, or English.
[[nodiscard]] Language language_of(const std::string& flag);

/// Where a user's settings are kept between runs, made when it is not there; empty: nowhere.
[[nodiscard]] std::filesystem::path config_folder();
/// The same of what people made: records and attempts.
[[nodiscard]] std::filesystem::path data_folder();

/// The file of keys that a user keeps, when none was named and there is one.
void take_own_keys(WindowOptions& window);

/// Errors: not_found, those of parse_script.
[[nodiscard]] Result<std::vector<ScriptStep>> read_script(const std::filesystem::path& file);

}  // namespace artus
