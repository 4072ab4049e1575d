// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>

#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What another part of the program said in English, in `language`: the first of `patterns`
/// ("locking memory: {}") that it fits is translated, and so is what stands in its places: a
/// sentence of `patterns`, a structure's name, or a number. Everything else stays as it was said.
/// Cost: one look through the patterns for each place. Errors: none.
[[nodiscard]] std::string retell(Language language, std::span<const char* const> patterns,
                                 const std::string& english);

}  // namespace artus
