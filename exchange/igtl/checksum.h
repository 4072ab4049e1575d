// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string_view>

namespace artus::igtl {

/// The checksum that a message's header carries for its body: CRC-64 with the polynomial of
/// ECMA-182, most significant bit first, starting from 0 and not inverted. `before`: that of the
/// bytes in front of these. Errors: none. Cost: about 0.6 ms a megabyte.
/// Source [OpenIGTLink] header specification.
[[nodiscard]] std::uint64_t checksum(std::string_view bytes, std::uint64_t before = 0) noexcept;

}  // namespace artus::igtl
