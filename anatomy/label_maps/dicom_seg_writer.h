// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/core/result.h"
#include "artus/detail/anatomy/label_maps/joint_labels.h"

namespace artus {

/// A binary DICOM segmentation object of a label map, little endian, uncompressed. Segment k + 1 is
/// segments[k]. A segment has frames where it has voxels; the body has one in every slice. Uids
/// follow from the voxels, so that the same labels give the same bytes. Errors: unsupported (a
/// build without DCMTK; more than 65535 rows or columns). Source: [DICOM] PS3.3 A.51, C.8.20.
[[nodiscard]] Result<std::string> to_dicom_seg(const JointLabels& labels,
                                               const std::string& comment);

}  // namespace artus
