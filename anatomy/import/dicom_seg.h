// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/label_volume.h"

namespace artus {

/// Whether this build reads DICOM (DCMTK).
[[nodiscard]] bool reads_dicom() noexcept;

/// A DICOM segmentation object, binary or fractional (from `threshold` of the largest value on),
/// uncompressed. Its frames are placed by their positions: it has only slices where segments are.
/// Where segments overlap, the one that stands first keeps the voxels. `names.labels` rename by
/// segment number. Errors: unsupported (another object, compressed pixels, a build without DICOM),
/// malformed (attributes that are missing), corrupt (fewer pixels than promised), invalid (frames
/// that are not slices of one grid, empty). Source: [DICOM] PS3.3 A.51, C.8.20.
[[nodiscard]] Result<LabelVolume> parse_dicom_seg(std::string_view bytes, const std::string& name,
                                                  const StructureNames& names,
                                                  double threshold = 0.5);

}  // namespace artus
