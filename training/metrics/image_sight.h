// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

namespace artus {

/// How the tip stands out in one picture.
struct ImageSight {
  double time = 0;  ///< s
  bool visible = false;
  std::optional<double> contrast_db;  ///< needle_contrast; empty where nothing of the tip shows
};
/// dB from which a tip is seen; assumed: 6, less what the dozen speckles at the tip waver by.
inline constexpr double kVisibleContrast = 4;
inline constexpr double kNotShown = -60;  ///< dB, of a tip of which nothing shows

}  // namespace artus
