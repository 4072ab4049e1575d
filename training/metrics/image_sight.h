// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

namespace artus {

/// How the tip stands out in one picture.
struct ImageSight {
  double time = 0;  ///< s
  bool visible = false;
  std::optional<double> contrast_db;  ///< tip_contrast; empty where nothing of the tip shows
};
inline constexpr double kVisibleContrast = 6;  ///< dB

}  // namespace artus
