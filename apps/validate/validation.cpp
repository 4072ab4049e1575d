// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/validate/validation.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "artus/detail/apps/options/device_options.h"
#include "artus/detail/apps/options/feel_options.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/evidence/validation/gate_report.h"
#include "artus/detail/evidence/validation/needle/experiment.h"

namespace artus {
namespace {

struct ValidationOptions {
  std::vector<std::string> what;  ///< sets, and gates of them
  std::vector<std::string> only;  ///< gates
  bool all = false;
  bool list = false;
  bool rigid = false;
  bool tissue = false;
  std::filesystem::path joint;
  std::filesystem::path out;
  std::filesystem::path results;
  GateOptions gates;
  std::int64_t seed = 1;
  FeelOptions feel;
  bool json = false;
};

/// Gates of one set that are to be measured.
struct Plan {
  const GateSet* set = nullptr;
  std::vector<std::string> gates;
};

/// The sets that were named, all when none was; gates that were named go to `only`.
std::vector<const GateSet*> chosen_sets(const ValidationOptions& options,
                                        std::vector<std::string>& only) {
  std::vector<const GateSet*> sets;
  for (const GateSet& set : gate_sets())
    if (std::find(options.what.begin(), options.what.end(), set.name) != options.what.end())
      sets.push_back(&set);
  for (const std::string& word : options.what)
    if (!find_gate_set(word)) only.push_back(word);
  if (sets.empty())
    for (const GateSet& set : gate_sets()) sets.push_back(&set);
  return sets;
}

Result<std::vector<Plan>> plan_of(const ValidationOptions& options) {
  std::vector<std::string> only = options.only;
  const std::vector<const GateSet*> sets = chosen_sets(options, only);
  const auto& reference = options.gates.reference;
  if (!reference.empty() && options.joint.empty() && !std::filesystem::is_directory(reference))
    return fail(ErrorCode::invalid,
                "a table of real pictures needs --joint; for plates give the folder",
                "--reference");
  if (options.all && !only.empty())
    return fail(ErrorCode::invalid, "either gates by name or --all", "--all");
  std::vector<std::string_view> known;
  std::vector<Plan> plans;
  for (const GateSet* set : sets) {
    const auto names = gate_names(set->name);
    known.insert(known.end(), names.begin(), names.end());
    Plan plan{set, {}};
    if (only.empty())
      for (const std::string_view name : gate_names(set->name, options.gates))
        plan.gates.emplace_back(name);
    for (const std::string& name : only)
      if (std::find(names.begin(), names.end(), name) != names.end()) plan.gates.push_back(name);
    if (!plan.gates.empty()) plans.push_back(std::move(plan));
  }
  for (const std::string& name : only) ARTUS_TRY(find_name(known, name, "gate", "--only"));
  return plans;
}

/// What the flags mean, with the joint loaded.
Result<GateOptions> gate_options_of(const ValidationOptions& options, const Progress& progress) {
  GateOptions gates = options.gates;
  gates.seed = static_cast<std::uint64_t>(options.seed);
  gates.tissue = options.tissue || !options.rigid;
  const auto feel = make_feel(options.feel);
  ARTUS_TRY(feel);
  gates.feel = *feel;
  if (options.joint.empty()) return gates;
  JointOptions joint;
  joint.joint = options.joint;
  auto loaded = load(joint, progress);
  ARTUS_TRY(loaded);
  gates.joint = std::move(*loaded);
  return gates;
}

void print(const Gate& gate) {
  std::printf("%s\n", gate.name.c_str());
  for (const Claim& claim : gate.claims) std::printf("  %s\n", to_line(claim).c_str());
  for (const std::string& number : gate.assumed) std::printf("  assumed: %s\n", number.c_str());
  for (const auto& [title, table] : gate.tables) {
    if (title != kBesideTable) continue;
    std::printf("  with tissue that gives way:\n");
    for (const auto& row : table.rows)
      std::printf("    %s: %s (rigid: %s; %s)\n", row[0].c_str(), row[3].c_str(), row[2].c_str(),
                  row[1].c_str());
  }
}

Result<std::vector<MeasuredSet>> measure(const std::vector<Plan>& plans, const GateOptions& options,
                                         bool json, const Progress& progress) {
  std::size_t total = 0;
  for (const Plan& plan : plans) total += plan.gates.size();
  std::size_t done = 0;
  std::vector<MeasuredSet> measured;
  for (const Plan& plan : plans) {
    MeasuredSet set{plan.set, {}};
    for (const std::string& name : plan.gates) {
      if (progress) progress(name, static_cast<double>(done++) / static_cast<double>(total));
      auto gate = run_gate(plan.set->name, name, options);
      ARTUS_TRY(gate);
      if (!json) print(*gate);
      set.gates.push_back(std::move(*gate));
    }
    measured.push_back(std::move(set));
  }
  return measured;
}

/// The reports in --out, a folder for each of several sets, and the pages in --results.
Result<void> write_all(const std::vector<MeasuredSet>& measured, const ValidationOptions& options,
                       const std::string& command) {
  for (const MeasuredSet& set : measured) {
    const std::string name(set.set->name);
    if (!options.out.empty())
      ARTUS_TRY(write_report(set, measured.size() == 1 ? options.out : options.out / name));
    if (!options.results.empty())
      ARTUS_TRY(write_text(options.results / (name + ".md"),
                           results_page(set, find_provenance(command))));
  }
  return {};
}

void print_list() {
  for (const GateSet& set : gate_sets()) {
    std::printf("%s: %s\n", std::string(set.name).c_str(), std::string(set.title).c_str());
    for (const GateEntry& entry : gate_entries())
      if (entry.set == set.name)
        std::printf("  %-20s %s%s\n", std::string(entry.name).c_str(),
                    std::string(entry.title).c_str(),
                    entry.needs == GateNeeds::nothing     ? ""
                    : entry.needs == GateNeeds::joint     ? " (with -j)"
                    : entry.needs == GateNeeds::reference ? " (with --reference DIR)"
                                                          : " (with -j and --reference)");
  }
}

/// Says what of the sets cannot be measured for want of real pictures.
void tell_skipped(const std::vector<Plan>& plans, const GateOptions& options) {
  if (std::filesystem::is_directory(options.reference)) return;
  for (const Plan& plan : plans)
    for (const GateEntry& entry : gate_entries())
      if (entry.set == plan.set->name && entry.needs == GateNeeds::reference)
        std::fprintf(stderr, "%s skipped: it needs --reference DIR, a folder of real pictures\n",
                     std::string(entry.name).c_str());
}

ExitCode run(const ValidationOptions& options, const std::string& command) {
  if (options.list) {
    print_list();
    return ExitCode::ok;
  }
  if (options.out.empty() && options.results.empty())
    return report_error({ErrorCode::invalid, "name a folder for the report", "--out"},
                        options.json);
  const Progress progress = make_progress_printer(options.json);
  const auto gates = gate_options_of(options, progress);
  if (!gates) return report_error(gates.error(), options.json);
  ValidationOptions with_joint = options;
  with_joint.gates = *gates;
  const auto plans = plan_of(with_joint);
  if (!plans) return report_error(plans.error(), options.json);
  tell_skipped(*plans, *gates);
  const auto measured = measure(*plans, *gates, options.json, progress);
  if (!measured) {
    Error error = at_flag(measured.error());
    if (error.code == ErrorCode::malformed && error.where.empty()) error.where = "--only";
    return report_error(error, options.json);
  }
  const auto written = write_all(*measured, options, command);
  if (!written) return report_error(written.error(), options.json);
  const std::vector<Claim> claims = all_claims(*measured);
  if (options.json)
    std::cout << verdict(*measured).dump(2) << '\n';
  else
    std::printf("%s\n", count_claims(claims).c_str());
  return all_hold(claims) ? ExitCode::ok : ExitCode::failed;
}

std::string sets_in_words() {
  std::string text;
  for (const GateSet& set : gate_sets())
    text += "  " + std::string(set.name) + std::string(11 - set.name.size(), ' ') +
            std::string(set.title) + "\n";
  return text;
}

void add_needle_options(Command& app, ValidationOptions& options) {
  app.add_option("--seed", options.seed, "seed of hand and noise")
      ->check(whole_number_in(0, 999999999))
      ->capture_default_str();
  add_device_option(&app, options.gates.device);
  app.add_option("--mock", options.gates.mock,
                 "TOML file of the pneumatic probe mock (default: the bundled one)");
  app.add_flag("--rigid", options.rigid,
               "the needle's experiments as published alone, not also in tissue that gives way");
  app.add_flag("--tissue", options.tissue, "")->group("");  // of `artus experiment`
  add_feel_options(&app, options.feel);
  add_needle_length_option(&app, options.feel.needle_length_mm);
}

}  // namespace

void add_validation(Command& app, ExitCode& code) {
  auto options = std::make_shared<ValidationOptions>();
  app.footer(
      "Sets:\n" + sets_in_words() +
      "Each claim is an input (put in), fitted (chosen with the answer in view) or independent;\n"
      "the last line counts them apart. Exit code 1 when a claim does not hold, also when\n"
      "docs/results/known-gaps.md says so. The needle's claims are those of the published laws:\n"
      "with others, those that fail are what the laws differ by.\n"
      "Examples:\n"
      "  artus validate --list\n"
      "  artus validate echo --only needle-angle --only tendon --out out/echo --json\n"
      "  artus validate realism --reference us_reference --out out/realism\n"
      "  artus validate soft -j meshes/shoulder --out out/soft\n"
      "  artus validate needle --only wall-stop --cutting voigt --out out/stop-voigt\n"
      "  artus validate echo -j shoulder.artus --reference stats.tsv --out out/echo\n"
      "  artus validate injection --results docs/results");
  app.add_option("what", options->what,
                 "needle, echo, realism, soft, injection, probe (default: all)");
  app.add_option("--only", options->only, "a gate, may be given several times (default: all)");
  app.add_flag("--all", options->all, "all gates of the sets, as without --only");
  app.add_flag("--list", options->list, "tell the gates of each set, and measure none");
  app.add_option("--joint,-j", options->joint,
                 "joint folder or compiled .artus file: gates of a joint are measured, too");
  Option* reference = app.add_option(
      "--reference", options->gates.reference,
      "real pictures: the folder that holds them, for realism's plates, or, with -j, "
      "their table (stats.tsv) to compare the joint's muscle with");
  app.add_option("--reference-rows", options->gates.reference_rows,
                 "how the names of its muscle images begin, several (default: all rows)")
      ->needs(reference);
  app.add_option("-o,--out", options->out, "folder for reports, plots, pictures and traces");
  app.add_option("--results", options->results, "folder for a page a set: SET.md");
  add_needle_options(app, *options);
  app.add_flag("--json", options->json, "print the verdicts as JSON");
  on_run(&app, code, [options, &app] { return run(*options, "artus validate " + app.line()); });
}

}  // namespace artus
