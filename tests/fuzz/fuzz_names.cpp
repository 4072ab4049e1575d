// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/structure_names.h"
#include "tests/fuzz/fuzz_surface.h"

/// Names for labels as TOML and as colour tables, and what is known of a name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text = artus::as_text(data, size);
  for (const bool is_table : {false, true}) {
    const auto names = is_table ? artus::parse_colour_table(text, "names.ctbl")
                                : artus::parse_structure_names(text, "names.toml");
    if (!names) {
      if (names.error().message.empty() || names.error().where.empty()) std::abort();
      continue;
    }
    static_cast<void>(artus::find_tissue(*names, *names, std::string(text.substr(0, 64)), {}));
  }
  return 0;
}
