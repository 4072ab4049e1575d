// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/dataset/shard_merge.h"

namespace artus {
namespace {

struct SweepMergeOptions {
  std::vector<std::string> folders;
  std::filesystem::path out;
  bool json = false;
};

ExitCode run_sweep_merge(const SweepMergeOptions& options) {
  const std::vector<std::filesystem::path> folders(options.folders.begin(), options.folders.end());
  const std::filesystem::path out =
      options.out.empty() ? folders.front() / "set.json" : options.out;
  const auto set = merge_shards(folders, out, make_progress_printer(options.json));
  if (!set) return report_error(set.error(), options.json);
  if (options.json)
    std::cout << nlohmann::json{{"frames", set->frames},
                                {"shards", set->shards},
                                {"bytes", set->bytes},
                                {"problems", set->problems}}
                     .dump(2)
              << '\n';
  for (const std::string& problem : set->problems)
    std::fprintf(stderr, "artus: %s\n", problem.c_str());
  if (!set->problems.empty()) return ExitCode::failed;
  if (!options.json)
    std::printf("%zu frames in %zu shards, each exactly once: %s\n", set->frames, set->shards,
                out.c_str());
  return ExitCode::ok;
}

}  // namespace

void add_sweep_merge_command(Command& sweep, ExitCode& code) {
  auto options = std::make_shared<SweepMergeOptions>();
  Command* command =
      add_command(sweep, "merge", "Is every frame of a sharded sweep there, exactly once?",
                  "Finds missing, doubled, foreign and damaged shards, or lists the whole set.\n"
                  "Examples:\n"
                  "  artus sweep merge out/set\n"
                  "  artus sweep merge node1/set node2/set -o set.json");
  command->add_option("folders", options->folders, "folders with shards")->required();
  command->add_option("-o,--out", options->out, "list of the set (default: set.json in the first)");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_sweep_merge(*options); });
}

}  // namespace artus
