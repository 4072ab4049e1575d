// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/dataset/shard_stats.h"
#include "artus/echo/image_io.h"

namespace artus {
namespace {

struct SweepStatsOptions {
  std::vector<std::string> folders;
  std::filesystem::path out;
  bool json = false;
};

ExitCode run_sweep_stats(const SweepStatsOptions& options) {
  const std::vector<std::filesystem::path> folders(options.folders.begin(), options.folders.end());
  const auto statistics = read_statistics(folders, make_progress_printer(options.json));
  if (!statistics) return report_error(statistics.error(), options.json);
  if (!options.out.empty())
    if (const auto written = write_image(histogram_page(*statistics), options.out); !written)
      return report_error(written.error(), options.json);
  if (options.json)
    std::cout << to_json(*statistics).dump(2) << '\n';
  else
    std::printf("%zu frames, %zu with a needle, %zu of these in plane\n", statistics->frames,
                statistics->with_needle, statistics->in_plane);
  return ExitCode::ok;
}

}  // namespace

void add_sweep_stats_command(Command& sweep, ExitCode& code) {
  auto options = std::make_shared<SweepStatsOptions>();
  Command* command =
      add_command(sweep, "stats", "What is in a set of shards: numbers and histograms",
                  "Examples:\n"
                  "  artus sweep stats out/set -o stats.png\n"
                  "  artus sweep stats node1/set node2/set --json");
  command->add_option("folders", options->folders, "folders with shards")->required();
  command->add_option("-o,--out", options->out, "page of histograms (.png)");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_sweep_stats(*options); });
}

}  // namespace artus
