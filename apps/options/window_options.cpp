// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/window_options.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace artus {
namespace {

/// artus's folder within the one that `variable` names, or within `usual` of the user's home.
std::filesystem::path own_folder(const char* variable, const char* usual) {
  const char* named = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): start-up
  const char* home = std::getenv("HOME");     // NOLINT(concurrency-mt-unsafe)
  std::filesystem::path folder;
  if (named != nullptr && *named != '\0')
    folder = named;
  else if (home != nullptr)
    folder = std::filesystem::path(home) / usual;
  else
    return {};
  std::error_code error;
  std::filesystem::create_directories(folder / "artus", error);
  return error ? std::filesystem::path() : folder / "artus";
}

}  // namespace

void add_window_options(Command* command, WindowOptions& window, std::string& language) {
  command->add_option("--width", window.width, "pixels")
      ->check(whole_number_in(320, 16384))
      ->capture_default_str();
  command->add_option("--height", window.height, "pixels")
      ->check(whole_number_in(240, 16384))
      ->capture_default_str();
  command->add_option("--window-rate", window.rate, "pictures a second, at most")
      ->check(number_in(0.5, 240))
      ->capture_default_str();
  command
      ->add_option("--font-scale", window.font_scale,
                   "of the letters, besides what screen and window ask for")
      ->check(number_in(0.5, 4))
      ->capture_default_str();
  add_language_option(command, language);
  command->add_option("--keys", window.keys,
                      "TOML file of other keys: push = \"8\" (default: keys.toml in "
                      "~/.config/artus)");
  command->add_flag("--left-handed", window.left_handed, "the mouse's buttons change places");
}

void add_language_option(Command* command, std::string& language) {
  command->add_option("--language", language, "en or fr (default: as the system's)")
      ->one_of({"en", "fr"});
}

Language language_of(const std::string& flag) {
  for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    if (const auto known = find_language(flag)) return *known;
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): start-up
    if (value != nullptr && *value != '\0') return find_language(value).value_or(Language::english);
  }
  return find_language(flag).value_or(Language::english);
}

std::filesystem::path config_folder() {
  return own_folder("XDG_CONFIG_HOME", ".config");
}

std::filesystem::path data_folder() {
  return own_folder("XDG_DATA_HOME", ".local/share");
}

void take_own_keys(WindowOptions& window) {
  const std::filesystem::path folder = config_folder();
  if (window.keys.empty() && !folder.empty() && std::filesystem::exists(folder / "keys.toml"))
    window.keys = (folder / "keys.toml").string();
}

Result<std::vector<ScriptStep>> read_script(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) return fail(ErrorCode::not_found, "cannot read the script", file);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  return parse_script(text, file);
}

}  // namespace artus
