// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/core/byte_stream.h"

namespace artus {

/// Tissues as bytes of a compiled joint; also what its digest says of them.
void put_tissues(ByteWriter& out, const std::vector<Tissue>& tissues);
[[nodiscard]] std::vector<Tissue> get_tissues(ByteReader& in);

}  // namespace artus
