// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>

#include "artus/detail/simulation/records.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// Knobs for a kind of examination.
struct ScannerPreset {
  const char* name;
  double depth;            ///< m
  double frequency;        ///< Hz
  double elevation_focus;  ///< m
};
/// assumed: what musculoskeletal guides recommend for the depth of each region.
inline constexpr std::array<ScannerPreset, 4> kPresets{
    {{msgid("shoulder"), 40e-3, 12e6, 20e-3},
     {msgid("knee"), 45e-3, 10e6, 25e-3},
     {msgid("deep (hip)"), 70e-3, 7e6, 40e-3},
     {msgid("shallow (hand)"), 25e-3, 16e6, 10e-3}}};

/// The knobs with those of a preset.
[[nodiscard]] inline ImageControls with_preset(ImageControls controls,
                                               const ScannerPreset& preset) noexcept {
  controls.depth = preset.depth;
  controls.frequency = preset.frequency;
  controls.elevation_focus = preset.elevation_focus;
  return controls;
}

}  // namespace artus
