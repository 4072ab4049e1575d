// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/anatomy/label_maps/joint_labels.h"

namespace artus {

/// The formats that a label map is written in.
enum class LabelFormat { nifti, nifti_gz, nrrd, seg_nrrd, metaimage, dicom };

/// By a file's ending: .nii, .nii.gz, .nrrd, .seg.nrrd, .mha, .dcm. Errors: unsupported, naming
/// these.
[[nodiscard]] Result<LabelFormat> label_format_of(const std::filesystem::path& file);

/// A label map as the bytes of a file; `comment` says what made it. Samples are of one byte, or of
/// two for more than 255 labels.
/// - NIfTI-1: sform and qform alike, names in a header extension as TotalSegmentator writes them.
/// - NRRD: gzip; the space is the one that the grid's axes follow; names as .seg.nrrd has them.
/// - .seg.nrrd: layer 0 are the structures, layer 1 all of the body, which they overlap.
/// - MetaImage: compressed; the format holds no names (to_names_toml).
/// - DICOM SEG: binary, a frame for each slice of a segment that has voxels in it, and for each
///   slice of the body, so that the whole grid is there.
/// Errors: unsupported (DICOM in a build without it; sizes that the format cannot hold).
[[nodiscard]] Result<std::string> to_label_file(const JointLabels& labels, LabelFormat format,
                                                const std::string& comment);

/// The names and tissues of the labels as `artus import --labels` takes them.
[[nodiscard]] Result<std::string> to_names_toml(const JointLabels& labels);

/// Whether a format holds the labels' names.
[[nodiscard]] constexpr bool holds_names(LabelFormat format) noexcept {
  return format != LabelFormat::metaimage;
}

}  // namespace artus
