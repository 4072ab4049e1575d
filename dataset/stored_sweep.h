// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"
#include "artus/echo/transducer.h"

namespace artus {

/// A frame of a sweep as its files hold it.
struct StoredFrame {
  ListedPose pose;
  Transducer transducer;
  double pixel = 0;                ///< m
  int width = 0;                   ///< pixels
  int height = 0;                  ///< pixels
  std::vector<std::uint8_t> grey;  ///< (height, width), x fastest
};

/// Gives each frame of a sweep's folder, or of a folder of shards, to `take`, in order; stops at
/// its first error. Errors: those of `take`; not_found (no sweep), unreadable; malformed or
/// corrupt, naming file and frame.
[[nodiscard]] Result<void> read_sweep(const std::filesystem::path& folder,
                                      const std::function<Result<void>(const StoredFrame&)>& take);

}  // namespace artus
