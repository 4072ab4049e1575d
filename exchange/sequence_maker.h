// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/sequence_file.h"
#include "artus/echo/transducer.h"

namespace artus {

/// A picture and where it was taken.
struct PlacedPicture {
  double time = 0;  ///< s
  Pose X_JP = Pose::Identity();
  std::optional<Pose> X_JN;
  double pixel = 0;                    ///< m
  int width = 0;                       ///< pixels
  int height = 0;                      ///< pixels
  std::span<const std::uint8_t> grey;  ///< (height, width), x fastest
};

/// Puts pictures together into a sequence, Reference as RAS.
class SequenceMaker {
 public:
  /// Errors: invalid, when its size is not that of those before.
  [[nodiscard]] Result<void> add(const PlacedPicture& picture, const Transducer& transducer);
  [[nodiscard]] const ImageSequence& sequence() const noexcept { return sequence_; }

 private:
  ReferenceFrame reference_;
  ImageSequence sequence_;
};

/// The pictures of a sweep's folder, or of a folder of shards; 25 a second where its poses have no
/// times. Errors: those of read_sweep and add; invalid, when it is empty.
[[nodiscard]] Result<ImageSequence> sequence_of_sweep(const std::filesystem::path& folder);

}  // namespace artus
