// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/core/byte_stream.h"

namespace artus {

/// A joint's own spaces as bytes, the last section of a compiled joint; one without has none.
void put_spaces(ByteWriter& out, const std::vector<Space>& spaces);
[[nodiscard]] std::vector<Space> get_spaces(ByteReader& in);

}  // namespace artus
