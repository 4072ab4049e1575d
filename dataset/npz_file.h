// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>

#include "artus/core/result.h"
#include "artus/detail/echo/display/rf_lines.h"

namespace artus {

/// Arrays as numpy's `load` takes them from a .npz: an archive of one .npy for each, stored as they
/// are and without times, so that the same arrays have the same bytes. Errors: unsupported (4 GiB
/// and more). Source [NumPy] numpy.lib.format 1.0, [ZIP].
[[nodiscard]] Result<std::string> npz_bytes(std::span<const NamedArray> arrays);

}  // namespace artus
