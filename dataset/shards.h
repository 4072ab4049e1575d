// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "artus/core/result.h"
#include "artus/dataset/sweep.h"
#include "artus/detail/core/progress.h"
#include "artus/detail/dataset/frame_order.h"

namespace artus {

/// Frames `first` to before `last`, or every `of`-th shard from the `turn`-th: what one job draws.
struct ShardJob {
  std::size_t first = 0;
  std::size_t last = 0;  ///< 0: to the end
  std::size_t turn = 0;
  std::size_t of = 1;
};
/// "k/N", k from 0; "a:b". Errors: malformed, naming the flag.
[[nodiscard]] Result<ShardJob> parse_turn(const std::string& text, const std::string& flag);
[[nodiscard]] Result<ShardJob> parse_frames(const std::string& text, const std::string& flag);

struct ShardOptions {
  SweepOptions sweep;         ///< restart and stop mean what they mean there
  std::size_t frames = 1000;  ///< in a shard: its range does not depend on the jobs
  std::string engine;         ///< version, for the sidecars
};

struct ShardResult {
  std::size_t shards = 0;  ///< of this job
  std::size_t found = 0;   ///< finished by earlier runs
  std::size_t drawn = 0;   ///< by this one
  std::size_t frames = 0;  ///< drawn by this one
  std::uint64_t bytes = 0;
};

/// Draws frames into WebDataset shards in `folder`: shard-NNNNNN.tar with NNNNNNNNN.png,
/// .labels.png (8 bit ids), .shadow.png, .needle.png (with a needle) and .json for each frame, and
/// shard-NNNNNN.json beside it (range, bytes, sha256, what was asked for, engine). A shard is there
/// whole or not at all, and has the same bytes whoever draws it; jobs may share the folder, and a
/// job that was killed loses its open shard alone.
/// Errors: invalid (persistence; frames that cut a shard; more than 256 regions; the folder holds
/// another sweep), unreadable.
[[nodiscard]] Result<ShardResult> write_shards(const std::shared_ptr<const Scene>& scene,
                                               const FrameSource& frames, const ShardJob& job,
                                               const std::filesystem::path& folder,
                                               const ShardOptions& options,
                                               const Progress& progress = {});

}  // namespace artus
