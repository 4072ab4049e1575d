// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

namespace artus {

/// A number with nine significant digits, '.' as decimal point in any locale.
[[nodiscard]] std::string to_csv(double value);

}  // namespace artus
