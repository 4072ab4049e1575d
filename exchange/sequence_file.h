// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"
#include "artus/detail/exchange/igtl/contents.h"

namespace artus {

/// One picture of a sequence with its place; matrices in millimetres, Reference as ReferenceFrame.
struct SequenceFrame {
  double time = 0;  ///< s since the first
  igtl::Matrix image_to_reference = igtl::Matrix::Zero();
  igtl::Matrix probe_to_reference = igtl::Matrix::Zero();
  std::optional<igtl::Matrix> needle_to_reference;
  std::vector<std::uint8_t> grey;  ///< (height, width), x fastest
};

/// A sequence as 3D Slicer and PLUS keep it.
struct ImageSequence {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  std::vector<SequenceFrame> frames;
};

/// The sequence as a MetaImage with a frame's transforms in its header (.igs.mha). Requires: at
/// least one frame, all of the same size.
[[nodiscard]] std::string to_mha(const ImageSequence& sequence);
/// The same as a file. Errors: unreadable.
[[nodiscard]] Result<void> write_mha(const std::filesystem::path& file,
                                     const ImageSequence& sequence);

/// Reads such a sequence: 8-bit grey, uncompressed, data in the file. Transforms that are not "OK"
/// are left out: a frame without a probe has a zero matrix. Errors: not_found, unreadable;
/// malformed, unsupported or corrupt, naming the key.
[[nodiscard]] Result<ImageSequence> read_mha(const std::filesystem::path& file);
[[nodiscard]] Result<ImageSequence> parse_mha(std::string_view bytes, const std::string& name);

/// The poses of a sequence in J, with Reference as RAS. Errors: invalid (no frame has a probe, or
/// a matrix that is no rigid pose, with the frame's number).
[[nodiscard]] Result<std::vector<ListedPose>> poses_of(const ImageSequence& sequence);

}  // namespace artus
