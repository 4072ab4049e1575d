// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
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

/// How pixels are kept in a file.
enum class PixelCoding { raw, zlib };

/// The sequence as a MetaImage with a frame's transforms in its header (.igs.mha). Requires: at
/// least one frame, all of the same size.
[[nodiscard]] std::string to_mha(const ImageSequence& sequence,
                                 PixelCoding coding = PixelCoding::raw);
/// The same as a file. Errors: unreadable.
[[nodiscard]] Result<void> write_mha(const std::filesystem::path& file,
                                     const ImageSequence& sequence,
                                     PixelCoding coding = PixelCoding::raw);

/// Reads such a sequence with its pixels: 8-bit grey, raw or compressed, data in the file.
/// Transforms that are not "OK" are left out: a frame without a probe has a zero matrix. Poses
/// alone are read of any sequence by read_sequence_header and track_of. Errors: not_found,
/// unreadable; malformed, unsupported or corrupt, naming every key that is at fault.
[[nodiscard]] Result<ImageSequence> read_mha(const std::filesystem::path& file);
[[nodiscard]] Result<ImageSequence> parse_mha(std::string_view bytes, const std::string& name);

}  // namespace artus
