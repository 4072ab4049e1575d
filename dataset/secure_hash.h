// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace artus {

/// The SHA-256 of bytes as 64 hex digits, as sha256sum prints it. Cost: some 5 ms a megabyte.
/// Source [FIPS180].
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

}  // namespace artus
