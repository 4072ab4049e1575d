// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <set>
#include <utility>

#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/options/scenario_options.h"
#include "artus/detail/training/patient_plans.h"
#include "artus/detail/training/scenario_check.h"

namespace artus {
namespace {

struct ScenarioCheckOptions {
  std::string what;
  std::string file;
  std::filesystem::path joint;
  std::string patient;
  bool all = false;
  bool no_play = false;
  Tries tries;
  std::optional<int> soft_tries;
  bool json = false;
};

/// What was found of one scenario.
struct Checked {
  Scenario scenario;
  std::vector<std::string> problems;
  std::optional<DifficultyInTissue> difficulty;
  [[nodiscard]] bool good() const {
    return problems.empty() && (!difficulty || difficulty->sound());
  }
};

/// A body and what is looked for in it: its levels differ in aids and marks, not in tissue.
std::string task_of(const Scenario& s) {
  return s.gel ? s.name : s.body().string() + "/" + s.target.structure;
}

/// A sample in tissue where nobody says how much: see the help. `is_first`: of its task.
Tries tries_of(const ScenarioCheckOptions& options, bool is_first) {
  Tries tries = options.tries;
  const bool samples = options.all && !options.soft_tries;
  tries.soft = samples && !is_first ? 0 : options.soft_tries.value_or(tries.soft);
  tries.soft_novices = !samples;
  return tries;
}

Result<Checked> check(Scenario scenario, const ScenarioCheckOptions& options, bool is_first) {
  const Progress progress = make_progress_printer(options.json);
  if (!options.patient.empty()) {
    auto other = of_patient(scenario, options.patient);
    ARTUS_TRY(other);
    scenario = std::move(*other);
  }
  const auto scene = load_scene(scenario, options.joint, progress);
  ARTUS_TRY(scene);
  follow_patient(scenario, **scene);
  Checked out;
  out.problems = find_problems(scenario, *scene);
  if (out.problems.empty() && !options.no_play) {
    const auto difficulty =
        measure_difficulty(scenario, *scene, tries_of(options, is_first), progress);
    ARTUS_TRY(difficulty);
    out.difficulty = *difficulty;
  }
  out.scenario = std::move(scenario);
  return out;
}

nlohmann::json to_json(const Difficulty& d) {
  return {{"tries", d.tries},
          {"expert_played", d.expert.played},
          {"expert_passes", d.expert.passes},
          {"expert_score", d.expert.score},
          {"expert_missed", d.expert.missed},
          {"novice_played", d.novice.played},
          {"novice_passes", d.novice.passes},
          {"novice_score", d.novice.score},
          {"broken_bodies", d.broken()},
          {"breakage", d.breakage()}};
}

nlohmann::json to_json(const Checked& c) {
  nlohmann::json json = {{"name", c.scenario.name},
                         {"level", c.scenario.level},
                         {"problems", c.problems},
                         {"good", c.good()}};
  if (c.difficulty) {
    json["difficulty"] = to_json(c.difficulty->rigid);
    if (c.difficulty->soft.tries > 0) {
      json["difficulty_in_tissue"] = to_json(c.difficulty->soft);
      json["difficulty_in_tissue"]["verdicts_compared"] = c.difficulty->compared;
      json["difficulty_in_tissue"]["verdicts_as_in_rigid_tissue"] = c.difficulty->alike;
    }
  }
  return json;
}

void print(const Difficulty& d) {
  std::printf("expert %d of %d (score %.0f), novice %d of %d (score %.0f)  ", d.expert.passes,
              d.expert.played, d.expert.score, d.novice.passes, d.novice.played, d.novice.score);
}

void print(const Checked& c) {
  std::printf("%-18s level %d  ", c.scenario.name.c_str(), c.scenario.level);
  if (c.difficulty) {
    print(c.difficulty->rigid);
    if (c.difficulty->soft.tries > 0) {
      std::printf("in tissue: ");
      print(c.difficulty->soft);
      std::printf("%d of %d verdicts as in rigid tissue  ", c.difficulty->alike,
                  c.difficulty->compared);
    }
  }
  std::printf("%s\n", c.good() ? "good" : "NOT GOOD");
  for (const std::string& problem : c.problems) std::printf("  %s\n", problem.c_str());
  if (c.difficulty && !c.good())
    for (const Fared* fared : {&c.difficulty->rigid.expert, &c.difficulty->soft.expert})
      for (const std::string& missed : fared->missed)
        std::printf("  experts: %s\n", missed.c_str());
  if (c.difficulty && c.difficulty->soft.broken() > 0)
    std::printf("  liquid leaves the body broken in %d of %d attempts; the first:\n%s",
                c.difficulty->soft.broken(),
                c.difficulty->soft.expert.played + c.difficulty->soft.novice.played,
                c.difficulty->soft.breakage().c_str());
}

ExitCode run_list(bool json) {
  auto all = nlohmann::json::array();
  for (const std::string_view text : bundled_scenario_texts()) {
    const auto s = parse_scenario(text, "bundled");
    if (!s) return report_error(s.error(), json);
    if (json)
      all.push_back({{"name", s->name}, {"level", s->level}, {"title", s->title}});
    else
      std::printf("%d  %-18s %s\n", s->level, s->name.c_str(), s->title.c_str());
  }
  if (json) std::cout << all.dump(2) << '\n';
  return ExitCode::ok;
}

ExitCode run_scenario(const ScenarioCheckOptions& options) {
  if (options.what == "list") return run_list(options.json);
  if (options.all != options.file.empty())
    return report_error({ErrorCode::malformed, "give one scenario, or --all", "--all"},
                        options.json);
  std::vector<Result<Scenario>> scenarios;
  if (options.all)
    for (const std::string_view text : bundled_scenario_texts())
      scenarios.push_back(parse_scenario(text, "bundled"));
  else
    scenarios.push_back(find_scenario(options.file));
  if (options.what == "show") {
    for (const auto& s : scenarios) {
      if (!s) return report_error(s.error(), options.json);
      std::fputs(s->text.c_str(), stdout);
    }
    return ExitCode::ok;
  }
  bool good = true;
  auto all = nlohmann::json::array();
  std::set<std::string> tasks;
  for (auto& s : scenarios) {
    if (!s) return report_error(s.error(), options.json);
    const bool is_first = tasks.insert(task_of(*s)).second;
    const auto checked = check(std::move(*s), options, is_first);
    if (!checked) return report_error(checked.error(), options.json);
    good = good && checked->good();
    if (options.json)
      all.push_back(to_json(*checked));
    else
      print(*checked);
  }
  if (options.json) std::cout << all.dump(2) << '\n';
  return good ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

Result<std::shared_ptr<const Scene>> load_scene(const Scenario& scenario,
                                                const std::filesystem::path& joint,
                                                const Progress& progress) {
  if (scenario.gel) return make_gel_scene(*scenario.gel);
  JointOptions options;
  options.joint = joint.empty() ? scenario.body() : joint;
  const auto loaded = load(options, progress);
  ARTUS_TRY(loaded);
  return std::make_shared<const Scene>(*loaded);
}

void add_scenario_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ScenarioCheckOptions>();
  Command* command = add_command(
      app, "scenario", "List, show and check scenarios",
      "check: can it be done at all, and is it neither too hard nor too easy: a simulated expert\n"
      "passes 19 of 20 seeds or more, a simulated novice 8 or fewer. All --tries are played in\n"
      "rigid tissue, the first --tissue-tries also in tissue that gives way, which takes seconds\n"
      "each, minutes where millilitres are given. Fewer than 20 are a sample: its experts must\n"
      "pass, and it is told how many verdicts are those of rigid tissue. With 20 the bar holds\n"
      "there, too; novices stop when enough have failed. Broken bodies are told. Exit code 1 when\n"
      "it is not so.\n"
      "Examples:\n"
      "  artus scenario list\n"
      "  artus scenario show gel-align > mine.toml\n"
      "  artus scenario check mine.toml --json\n"
      "  artus scenario check --all --no-play");
  command->add_option("what", options->what, "list, show or check")
      ->required()
      ->one_of({"list", "show", "check"});
  command->add_option("scenario", options->file, "a file, or the name of a bundled one");
  command->add_flag("--all", options->all, "every bundled scenario");
  command->add_option("--joint,-j", options->joint, "in place of the scenario's");
  add_patient_option(command, options->patient);
  command->add_flag("--no-play", options->no_play, "only whether it can be done");
  command->add_option("--tries", options->tries.rigid, "seeds of each simulated operator")
      ->check(whole_number_in(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--tissue-tries", options->soft_tries,
                   "seeds of each in tissue that gives way; 20: all (default: 1; with --all 1, by "
                   "the expert alone, of the first level of each task)")
      ->check(whole_number_in(0, 1000));
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_scenario(*options); });
}

}  // namespace artus
