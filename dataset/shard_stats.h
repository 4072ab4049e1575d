// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include <nlohmann/json.hpp>

#include "artus/core/result.h"
#include "artus/detail/core/progress.h"

namespace artus {

/// What is in a set of shards, from the frames' lines of truth.
struct SetStatistics {
  std::size_t frames = 0;
  std::size_t with_needle = 0;
  std::size_t in_plane = 0;                   ///< of those with a needle
  std::size_t tip_in_picture = 0;             ///< of those with a needle, as the next two
  std::size_t tip_shown = 0;                  ///< sound reaches it
  std::size_t tip_visible = 0;                ///< and it lies in the slice
  std::map<std::string, std::size_t> tip_in;  ///< needles whose tip is in a tissue, by its name
  std::map<std::string, std::vector<double>>
      values;                                  ///< by name with unit, one a frame that has it
  std::map<std::string, std::size_t> regions;  ///< frames that show a region, by its name
};

/// Reads every shard of the folders. Errors: not_found (no shard), corrupt (an archive), malformed
/// (a line of truth), unreadable.
[[nodiscard]] Result<SetStatistics> read_statistics(
    const std::vector<std::filesystem::path>& folders, const Progress& progress = {});

/// Counts, and five-number summaries (least, quartiles, most) of the values.
[[nodiscard]] nlohmann::json to_json(const SetStatistics& statistics);

/// A page of histograms, one for each value, and the regions' shares (CV_8UC3).
[[nodiscard]] cv::Mat histogram_page(const SetStatistics& statistics);

}  // namespace artus
