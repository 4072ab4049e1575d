// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <vector>

#include "artus/detail/apps/options/experiment_catalogue.h"
#include "artus/detail/apps/options/hand_options.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/evidence/validation/needle/experiment.h"
#include "artus/detail/evidence/validation/soft/needled_block.h"

namespace artus {
namespace {

struct ExperimentCommandOptions {
  std::string name;
  bool all = false;
  bool tissue = false;
  std::filesystem::path out;
  ExperimentOptions experiment;
  std::int64_t seed = 1;
  FeelOptions feel;
  bool json = false;
};

constexpr double kRadius21 = 0.409e-3;  // m, of a 21 G needle

const TextTable* find_beside(const EvidenceReport& report) {
  for (const auto& [title, table] : report.tables)
    if (title == kBesideTable) return &table;
  return nullptr;
}

void print(const EvidenceReport& report) {
  std::printf("%s\n", report.name.c_str());
  for (const auto& claim : report.claims) std::printf("  %s\n", to_line(claim).c_str());
  const TextTable* beside = find_beside(report);
  if (beside == nullptr) return;
  std::printf("  with tissue that gives way:\n");
  for (const auto& row : beside->rows)
    std::printf("    %s: %s (rigid: %s; %s)\n", row[0].c_str(), row[3].c_str(), row[2].c_str(),
                row[1].c_str());
}

/// What the flags mean. Errors: invalid, with the flag.
Result<ExperimentOptions> make_options(const ExperimentCommandOptions& options) {
  if (options.name.empty() && !options.all)
    return fail(ErrorCode::invalid, "name an experiment, or give --all", "--all");
  if (!options.name.empty() && options.all)
    return fail(ErrorCode::invalid, "either one experiment's name or --all", "--all");
  ExperimentOptions run = options.experiment;
  run.seed = static_cast<std::uint64_t>(options.seed);
  const auto feel = make_feel(options.feel);
  ARTUS_TRY(feel);
  if (options.all && changed(*feel) != 0)
    return fail(ErrorCode::invalid,
                "the report is of the published laws; give the flags of force laws to one "
                "experiment",
                "--all");
  run.feel = *feel;
  if (options.tissue) run.tissue = NeedledBlock().compliance(kRadius21);
  return run;
}

ExitCode run_experiments(const ExperimentCommandOptions& options) {
  const auto run = make_options(options);
  if (!run) return report_error(run.error(), options.json);
  std::vector<std::string> names;
  if (options.all) {
    for (const auto name : all_experiments()) names.emplace_back(name);
  } else {
    names.push_back(options.name);
  }
  const Progress progress = make_progress_printer(options.json);
  std::string report =
      "# Experiments\n\nThe published experiments, run closed loop on device `" + run->device +
      "` with seed " + std::to_string(run->seed) +
      ". The medical test (figures 4-19 to 4-24) needs a joint: `artus run three-injections`.\n";
  nlohmann::json verdicts = nlohmann::json::object();
  std::vector<Claim> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (progress) progress(names[i], static_cast<double>(i) / static_cast<double>(names.size()));
    const auto folder = options.all ? options.out / names[i] : options.out;
    const auto experiment = run_experiment(names[i], folder, *run);
    if (!experiment) return report_error(at_flag(experiment.error()), options.json);
    const std::vector<Claim>& claims = experiment->claims;
    all.insert(all.end(), claims.begin(), claims.end());
    report += "\n## " + names[i] + "\n\n" + to_markdown(*experiment, names[i]);
    verdicts[names[i]] = verdict(claims);
    if (const TextTable* beside = find_beside(*experiment))
      for (const auto& row : beside->rows) verdicts[names[i]]["with_tissue"][row[0]] = row[3];
    if (!options.json) print(*experiment);
  }
  if (options.all)
    if (const auto written =
            write_text(options.out / "report.md", report + "\n" + count_claims(all) + ".\n");
        !written)
      return report_error(written.error(), options.json);
  if (options.json)
    std::cout << verdicts.dump(2) << '\n';
  else
    std::printf("%s\n", count_claims(all).c_str());
  return all_hold(all) ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_experiment_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ExperimentCommandOptions>();
  Command* command = add_command(
      app, "experiment", "Replay a published experiment: trace, plot and a verdict on each claim",
      "Experiments: " + listed(all_experiments()) +
          "\nEach claim is an input (put in), fitted (chosen with the answer in view) or "
          "independent;\n"
          "the last line counts them apart. Exit code 1 when a claim does not hold, also when\n"
          "docs/haptics.md or docs/probe.md says so. The claims are those of the published laws: "
          "with\n"
          "others, those that fail are what the laws differ by.\n"
          "Examples:\n"
          "  artus experiment wall-move --out out/wall-move\n"
          "  artus experiment wall-stop --cutting voigt --out out/stop-voigt\n"
          "  artus experiment rates --cutting muscle=spring --patient friction=1.5 --out "
          "out/rates\n"
          "  artus experiment layer-changes --tissue --out out/layers\n"
          "  artus experiment --all --out out/experiments     (with report.md)");
  command->add_option("name", options->name, "which experiment");
  command->add_flag("--all", options->all, "all of them, with one report");
  command->add_option("-o,--out", options->out, "folder for the results")->required();
  command->add_option("--seed", options->seed, "seed of hand and noise")
      ->check(whole_number_in(0, 999999999))
      ->capture_default_str();
  add_device_option(command, options->experiment.device);
  command->add_option("--mock", options->experiment.mock,
                      "TOML file of the pneumatic probe mock (default: the bundled one)");
  command->add_flag("--tissue", options->tissue,
                    "run the needle's experiments in tissue that gives way, too, and report both");
  add_feel_options(command, options->feel);
  add_needle_length_option(command, options->feel.needle_length_mm);
  command->add_flag("--json", options->json, "print the verdicts as JSON");
  on_run(command, code, [options] { return run_experiments(*options); });
}

}  // namespace artus
