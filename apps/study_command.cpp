// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <set>

#include <nlohmann/json.hpp>

#include "artus/detail/apps/commands.h"
#include "artus/detail/core/plot.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/training/norms.h"
#include "artus/detail/training/records.h"
#include "artus/detail/training/reliability.h"

namespace artus {
namespace {

struct StudyOptions {
  std::filesystem::path records;
  std::string experts = kExperts;
  std::filesystem::path plot;
  bool json = false;
};

/// Values by person (or attempt) and condition.
using Cells = std::map<std::string, std::map<std::string, std::vector<double>>>;

/// Means of the persons that have a value under each condition that most have; empty when there are
/// not two of each.
Eigen::MatrixXd crossed(const Cells& cells) {
  std::map<std::string, std::size_t> seen;
  for (const auto& [person, own] : cells)
    for (const auto& [condition, values] : own) ++seen[condition];
  std::vector<std::string> conditions;
  for (const auto& [condition, n] : seen)
    if (2 * n >= cells.size()) conditions.push_back(condition);
  std::vector<std::vector<double>> rows;
  for (const auto& [person, own] : cells) {
    std::vector<double> row;
    for (const std::string& condition : conditions) {
      const auto at = own.find(condition);
      if (at == own.end()) break;
      double sum = 0;
      for (const double value : at->second) sum += value;
      row.push_back(sum / static_cast<double>(at->second.size()));
    }
    if (row.size() == conditions.size()) rows.push_back(std::move(row));
  }
  if (rows.size() < 2 || conditions.size() < 2) return {};
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()),
                      static_cast<Eigen::Index>(conditions.size()));
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    for (Eigen::Index j = 0; j < out.cols(); ++j)
      out(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return out;
}

nlohmann::json reliability_of(const std::string& of, const std::string& over, const Cells& cells) {
  nlohmann::json out = {{"of", of}, {"over", over}};
  const Eigen::MatrixXd values = crossed(cells);
  if (values.size() == 0) return out;
  const VarianceParts parts = split_variance(values);
  out.update({{"persons", parts.persons},
              {"conditions", parts.conditions},
              {"variance_person", parts.person},
              {"variance_condition", parts.condition},
              {"variance_rest", parts.rest},
              {"cronbach_alpha", cronbach_alpha(values)},
              {"icc_single", parts.absolute(1)},
              {"icc_mean", parts.absolute(parts.conditions)},
              {"conditions_for_0.8", parts.conditions_for(0.8)}});
  return out;
}

/// Scores of a scenario's attempts that count, by group.
struct Groups {
  std::vector<double> experts;
  std::vector<double> novices;
};

PlotPanel plot_groups(const std::string& scenario, const Groups& groups) {
  PlotSeries fail{scenario + ": experts that would fail", {}, {}};
  PlotSeries pass{"others that would pass", {}, {}};
  for (int cut = 0; cut <= 100; ++cut) {
    const auto below = [cut](const std::vector<double>& scores) {
      return 100.0 *
             static_cast<double>(
                 std::count_if(scores.begin(), scores.end(), [cut](double s) { return s < cut; })) /
             static_cast<double>(scores.size());
    };
    fail.x.push_back(cut);
    fail.y.push_back(below(groups.experts));
    pass.x.push_back(cut);
    pass.y.push_back(100 - below(groups.novices));
  }
  return {.x_label = "pass mark, score", .y_label = "%", .series = {fail, pass}};
}

/// Everything that a study says, and its diagrams.
struct Study {
  nlohmann::json reliability = nlohmann::json::array();
  nlohmann::json cuts = nlohmann::json::array();
  Plot plot;
};

Result<void> add_scores(Records& records, const StudyOptions& options, Study& study) {
  const auto attempts = records.attempts();
  ARTUS_TRY(attempts);
  const auto experts = records.attempts({"", options.experts, ""});
  ARTUS_TRY(experts);
  std::set<std::string> of_experts;
  for (const AttemptRecord& a : *experts) of_experts.insert(a.id);
  Cells by_person;
  std::map<std::string, Groups> groups;
  for (const AttemptRecord& a : *attempts) {
    if (a.ended.empty() || a.aided || a.person.empty()) continue;
    by_person[a.person][a.scenario].push_back(a.score);
    Groups& group = groups[a.scenario];
    (of_experts.count(a.id) != 0 ? group.experts : group.novices).push_back(a.score);
  }
  study.reliability.push_back(reliability_of("score", "scenarios", by_person));
  for (const auto& [scenario, group] : groups) {
    if (group.experts.empty() || group.novices.empty()) continue;
    const GroupCut cut = find_group_cut(group.experts, group.novices);
    study.cuts.push_back({{"scenario", scenario},
                          {"experts", group.experts.size()},
                          {"others", group.novices.size()},
                          {"cut", cut.cut},
                          {"experts_fail", cut.experts_fail},
                          {"others_pass", cut.novices_pass}});
    study.plot.panels.push_back(plot_groups(scenario, group));
  }
  return {};
}

Result<void> add_ratings(Records& records, Study& study) {
  const auto attempts = records.attempts();
  ARTUS_TRY(attempts);
  std::map<std::string, Cells> by_rater;  // of instrument and item
  std::map<std::string, Cells> by_item;   // of instrument; one row a rating of an attempt
  for (const AttemptRecord& a : *attempts) {
    const auto ratings = records.ratings(a.id);
    ARTUS_TRY(ratings);
    for (const RatingRecord& r : *ratings) {
      by_rater[r.instrument + ", " + r.item][a.id][r.rater].push_back(r.value);
      by_item[r.instrument][a.id + " " + r.rater][r.item].push_back(r.value);
    }
  }
  for (const auto& [name, cells] : by_rater)
    study.reliability.push_back(reliability_of(name, "raters", cells));
  for (const auto& [name, cells] : by_item)
    study.reliability.push_back(reliability_of(name, "items", cells));
  return {};
}

void print_study(const Study& study) {
  for (const auto& r : study.reliability) {
    const std::string head = r["of"].get<std::string>() + " over " + r["over"].get<std::string>();
    if (!r.contains("persons")) {
      std::printf("%-32s too few: two persons with two of them each are needed\n", head.c_str());
      continue;
    }
    std::printf("%-32s %d x %d  alpha %.2f  ICC single %.2f, mean %.2f  for 0.8: %d\n",
                head.c_str(), r["persons"].get<int>(), r["conditions"].get<int>(),
                r["cronbach_alpha"].get<double>(), r["icc_single"].get<double>(),
                r["icc_mean"].get<double>(), r["conditions_for_0.8"].get<int>());
  }
  for (const auto& c : study.cuts)
    std::printf("%-18s pass mark %.0f: %.0f %% of %zu experts fail, %.0f %% of %zu others pass\n",
                c["scenario"].get<std::string>().c_str(), c["cut"].get<double>(),
                100 * c["experts_fail"].get<double>(), c["experts"].get<std::size_t>(),
                100 * c["others_pass"].get<double>(), c["others"].get<std::size_t>());
  if (study.cuts.empty())
    std::printf("no pass marks: no scenario has attempts of experts and of others\n");
}

Result<void> run_study(const StudyOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::exists(options.records, ignored))
    return fail(ErrorCode::not_found,
                "there is no such file of records; artus learners add begins one",
                options.records.string());
  auto records = Records::open(options.records);
  ARTUS_TRY(records);
  Study study;
  ARTUS_TRY(add_scores(*records, options, study));
  ARTUS_TRY(add_ratings(*records, study));
  if (!options.plot.empty()) {
    study.plot.title = "pass marks between experts and others";
    ARTUS_TRY(write_plot(options.plot, study.plot));
  }
  if (options.json)
    std::cout << nlohmann::json({{"reliability", study.reliability}, {"cuts", study.cuts}}).dump(2)
              << '\n';
  else
    print_study(study);
  return {};
}

}  // namespace

void add_study_command(Command& learners, ExitCode& code) {
  auto options = std::make_shared<StudyOptions>();
  Command* command = add_command(
      learners, "study", "How far scores and ratings can be trusted: reliability and pass marks",
      "Reliability of scores over scenarios and of ratings over raters and items: Cronbach's\n"
      "alpha, the intraclass correlation of one and of the mean, how many are needed for 0.8.\n"
      "Only persons with a value under each condition count. Pass marks by contrasting groups:\n"
      "the score that separates --experts from all others with the fewest errors.\n"
      "Examples:\n"
      "  artus learners study --records school.db\n"
      "  artus learners study --records school.db --experts experts --plot cuts.svg");
  command->add_option("--records", options->records, "file of the records")->required();
  command->add_option("--experts", options->experts, "cohort of who can do it")
      ->capture_default_str();
  command->add_option("--plot", options->plot, "file of the diagrams (.svg)");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] {
    const auto done = run_study(*options);
    return done ? ExitCode::ok : report_error(done.error(), options->json);
  });
}

}  // namespace artus
