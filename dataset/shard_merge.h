// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/core/progress.h"

namespace artus {

struct MergedSet {
  std::size_t frames = 0;
  std::size_t shards = 0;
  std::uint64_t bytes = 0;
  std::vector<std::string> problems;  ///< missing, doubled, foreign, damaged; empty: all is there
};

/// Looks through the shards of these folders and demands every frame exactly once, from one sweep,
/// with the bytes that their sidecars promise. When all is there, writes `out` (JSON): the sweep,
/// and the shards in order with range, size and sha256. Errors: not_found (no shard), unreadable.
[[nodiscard]] Result<MergedSet> merge_shards(const std::vector<std::filesystem::path>& folders,
                                             const std::filesystem::path& out,
                                             const Progress& progress = {});

}  // namespace artus
