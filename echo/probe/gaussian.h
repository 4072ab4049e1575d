// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace artus {

/// Standard deviation of a Gaussian over its full width at half maximum: 1 / (2 sqrt(2 ln 2)).
inline constexpr double kSigmaPerWidth = 1 / 2.3548200450309493;

}  // namespace artus
