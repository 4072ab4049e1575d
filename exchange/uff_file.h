// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/core/result.h"
#include "artus/detail/echo/display/rf_lines.h"

namespace artus {

/// Lines before the envelope as a file of the UltraSound ToolBox's Ultrasound File Format (HDF5,
/// v1.2.0): `/iq` and `/rf`, both of class uff.beamformed_data with scan, probe and pulse. `info`
/// says that they are beamformed by the engine and that the probe's rows are where lines leave the
/// face, not elements: there is no channel data. The same lines have the same bytes.
/// Errors: failed (HDF5 refuses). Source [UFF], [HDF5].
[[nodiscard]] Result<std::string> uff_bytes(const RfLines& lines);

}  // namespace artus
