// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/viewer/input/key_map.h"

namespace artus {

/// A line of the help: keys that belong together ("D, shift+D"), and what they do.
struct HelpRow {
  std::string keys;
  const char* what;
};
/// Every action's key, as the map has it, in the order of an injection. Errors: none.
[[nodiscard]] std::vector<HelpRow> help_rows(const KeyMap& keys, Language language);

}  // namespace artus
