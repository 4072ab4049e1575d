// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>

#include "artus/detail/training/records.h"

namespace artus {

/// "grey-heron-42": easy to keep in mind, of nobody's name, and of none of `taken`. Cost: a few
/// draws; 16 hex digits when a thousand of them are taken.
[[nodiscard]] std::string make_pseudonym(std::span<const PersonRecord> taken);

}  // namespace artus
