// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/devices/kit/tracker.h"

namespace artus::kit {

/// A kit with what was measured of it so far, as its file `hands.toml` has it: [print] ruler_mm,
/// hand, block_mm; [camera]; [[marker]] where they are glued; [needle]; [face].
struct MeasuredKit {
  Kit kit;
  double scale = 1;          ///< of the prints
  bool has_camera = false;   ///< the camera was calibrated
  bool has_markers = false;  ///< the glued markers were
  bool has_tip = false;      ///< the needle's tip was
  bool has_face = false;     ///< the probe's face was
};

/// As printed, before anything was measured. `scale`: see make_probe_body.
[[nodiscard]] MeasuredKit make_kit(Hand hand, double scale, double block_height);

/// Errors: malformed (with line), invalid (a key that is not known, a number that cannot be), all
/// problems in one message.
[[nodiscard]] Result<MeasuredKit> parse_kit(std::string_view text, const std::string& name);
/// Errors: also not_found, unreadable.
[[nodiscard]] Result<MeasuredKit> read_kit(const std::filesystem::path& file);
/// Reading it gives the same kit.
[[nodiscard]] std::string to_toml(const MeasuredKit& kit);

}  // namespace artus::kit
