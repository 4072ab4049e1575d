// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <set>

#include "artus/detail/core/plot.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/reports/attempt_page.h"
#include "artus/detail/reports/html_page.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/reports/number_words.h"
#include "artus/detail/training/judgement.h"
#include "artus/detail/training/learning_curve.h"
#include "artus/detail/training/learning_fit.h"
#include "artus/detail/training/metrics/sight_course.h"
#include "artus/detail/training/scenario.h"

namespace artus {
namespace {

constexpr FailureRates kRates{0.1, 0.2};
constexpr double kLimit = 2.5;

/// The outcomes that count: finished, and without aids.
std::unique_ptr<bool[]> outcomes(const std::vector<AttemptRecord>& attempts, std::size_t& n) {
  auto failed = std::make_unique<bool[]>(attempts.size());
  n = 0;
  for (const AttemptRecord& a : attempts)
    if (!a.ended.empty() && !a.aided) failed[n++] = !a.passed;
  return failed;
}

constexpr double kMemory = 0.95;  // weight of an attempt for each one since
constexpr const char* kPale = "#9db8d6";
constexpr const char* kDark = "#1f5fa8";

std::vector<double> numbered(std::size_t n) {
  std::vector<double> x(n);
  std::iota(x.begin(), x.end(), 1.0);
  return x;
}

/// What was believed of the rate of failure after each attempt, with its band.
PlotPanel plot_belief(std::span<const bool> failed, Language language) {
  PlotSeries mean{
      translate(language, "rate of failure"), numbered(failed.size()), {}, PlotStyle::line, kDark};
  PlotSeries low{translate(language, "90 % band"), mean.x, {}, PlotStyle::line, kPale};
  PlotSeries high{"", mean.x, {}, PlotStyle::line, kPale};
  for (std::size_t i = 1; i <= failed.size(); ++i) {
    const FailureBelief belief = believe(failed.first(i), kMemory);
    mean.y.push_back(100 * belief.mean);
    low.y.push_back(100 * belief.low);
    high.y.push_back(100 * belief.high);
  }
  return {.x_label = translate(language, "attempt without aids"),
          .y_label = "%",
          .series = {low, high, mean},
          .levels = {{100 * kRates.acceptable, translate(language, "adequate")}, {0, ""}}};
}

/// Scores of the finished attempts without aids.
PlotPanel plot_scores(const std::vector<AttemptRecord>& attempts, Language language) {
  PlotSeries scores{"", {}, {}, PlotStyle::points};
  for (const AttemptRecord& a : attempts)
    if (!a.ended.empty() && !a.aided) scores.y.push_back(a.score);
  scores.x = numbered(scores.y.size());
  return {.x_label = translate(language, "attempt without aids"),
          .y_label = translate(language, "score"),
          .series = {scores},
          .levels = {{100, ""}, {0, ""}}};
}

/// "2026-01-31 12:00" of "2026-01-31T12:00:00Z".
std::string to_the_minute(const std::string& utc) {
  std::string shown = utc.substr(0, 16);
  std::replace(shown.begin(), shown.end(), 'T', ' ');
  return shown;
}

void add_scenario(HtmlPage& page, const std::string& name,
                  const std::vector<AttemptRecord>& attempts) {
  const Language language = page.language();
  const auto percent = [language](double share) {
    return number(language, 100 * share, 0);
  };
  page.heading(name);
  std::size_t n = 0;
  const auto failed = outcomes(attempts, n);
  const std::span<const bool> x(failed.get(), n);
  const Chart chart = lc_cusum(x, kRates, kLimit);
  const FailureBelief belief = believe(x, kMemory);
  const double wrong =
      lc_cusum_pass_rate(kRates, kLimit, kRates.unacceptable, std::max<std::size_t>(n, 1));
  page.point(chart.signal ? msgid("passed") : msgid("note"),
             chart.signal ? fill(translate(page, "Adequate since attempt {}."),
                                 {std::to_string(*chart.signal)})
                          : translate(page, "Not yet shown to be adequate."));
  page.paragraph(
      fill(translate(page,
                     "Rate of failure between {} and {} % (90 % band, older attempts weigh less)."),
           {percent(belief.low), percent(belief.high)}) +
      " " +
      fill(translate_count(language,
                           "Of learners who stay at 20 % failure, {} % would be signalled within "
                           "{} attempt by chance.",
                           "Of learners who stay at 20 % failure, {} % would be signalled within "
                           "{} attempts by chance.",
                           static_cast<long>(n)),
           {percent(wrong), std::to_string(n)}));
  PlotSeries curve{"", {}, chart.values};
  for (std::size_t i = 0; i < n; ++i) curve.x.push_back(static_cast<double>(i + 1));
  if (n > 0)
    page.drawing(
        to_svg(PlotPanel{.x_label = translate(page, "attempt without aids"),
                         .y_label = "LC-CUSUM",
                         .series = {curve},
                         .levels = {{kLimit, translate(page, "adequate from here")}, {0, ""}}}),
        translate(page, "rises with each pass, falls with each failure (10 against 20 %)"));
  if (n > 1) {
    page.drawing(to_svg(plot_belief(x, language)),
                 translate(page, "share that fails, as the attempts so far tell it"));
    page.drawing(to_svg(plot_scores(attempts, language)), translate(page, "score, of 100"));
  }
  std::vector<std::vector<std::string>> rows;
  for (const AttemptRecord& a : attempts)
    rows.push_back({to_the_minute(a.started),
                    a.ended.empty() ? translate(page, "unfinished")
                    : a.passed      ? translate(page, "passed")
                                    : translate(page, "failed"),
                    a.ended.empty() ? "-" : std::to_string(whole_points(a.score)),
                    a.aided ? translate(page, "yes") : translate(page, "no"), a.id});
  page.table({{translate(page, "when"), "UTC"},
              {"", ""},
              {translate(page, "score"), translate(page, "of 100")},
              {translate(page, "aids"), translate(page, "nobody passes with aids on")},
              {translate(page, "attempt"), translate(page, "for artus learners rate")}},
             rows);
}

/// How many of a scenario's learners failed at their n-th attempt without aids.
std::vector<TrialCount> count_trials(
    const std::map<std::string, std::vector<AttemptRecord>>& learners) {
  std::vector<TrialCount> trials;
  for (const auto& [person, own] : learners) {
    std::size_t n = 0;
    const auto failed = outcomes(own, n);
    if (trials.size() < n) trials.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      ++trials[i].learners;
      trials[i].failures += failed[i] ? 1 : 0;
    }
  }
  return trials;
}

/// Share of the learners that failed at each trial, and the curve that these shares follow.
void add_curve(HtmlPage& page, const std::string& scenario, const std::vector<TrialCount>& trials) {
  constexpr std::size_t kFewest = 5;  // trials under which three numbers say nothing
  if (trials.size() < kFewest) return;
  const LearningFit fit = fit_learning(trials);
  const Language language = page.language();
  PlotSeries shares{
      translate(page, "failed"), numbered(trials.size()), {}, PlotStyle::points, kDark};
  PlotSeries curve{translate(page, "learning curve"), shares.x, {}, PlotStyle::line, "#a3361f"};
  PlotSeries low{translate(page, "90 % band of a share"), shares.x, {}, PlotStyle::line, kPale};
  PlotSeries high{"", shares.x, {}, PlotStyle::line, kPale};
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto failures = static_cast<double>(trials[i].failures);
    const auto learners = static_cast<double>(trials[i].learners);
    const auto outcome = std::make_unique<bool[]>(trials[i].learners);
    std::fill_n(outcome.get(), trials[i].failures, true);
    const FailureBelief belief = believe({outcome.get(), trials[i].learners});
    shares.y.push_back(100 * failures / learners);
    curve.y.push_back(100 * fit.at(i + 1));
    low.y.push_back(100 * belief.low);
    high.y.push_back(100 * belief.high);
  }
  page.heading(fill(translate(page, "Learning: {}"), {scenario}));
  page.paragraph(fill(translate(page,
                                "Failure comes down from {} % to {} %; each attempt takes {} % of "
                                "what is left (the most likely curve; vague for few learners or "
                                "few attempts)."),
                      {number(language, 100 * fit.first, 0), number(language, 100 * fit.last, 0),
                       number(language, 100 * fit.rate, 1)}));
  page.drawing(to_svg(PlotPanel{.x_label = translate(page, "attempt without aids"),
                                .y_label = "%",
                                .series = {low, high, shares, curve},
                                .levels = {{0, ""}}}),
               translate(page, "share of the learners who failed at their n-th attempt"));
}

/// The scenarios that come with artus by name, for their titles and order.
std::vector<Scenario> offered() {
  std::vector<Scenario> all;
  for (const std::string_view text : bundled_scenario_texts())
    if (auto scenario = parse_scenario(text, "bundled")) all.push_back(std::move(*scenario));
  return all;
}

std::string title_of(const std::vector<Scenario>& all, const std::string& name, Language language) {
  for (const Scenario& scenario : all)
    if (scenario.name == name) return title_words(language, scenario);
  return name;
}

/// The first scenario after one that someone has not passed.
std::string next_of(const std::vector<Scenario>& all, const std::set<std::string>& passed) {
  for (const Scenario& scenario : all)
    if (passed.count(scenario.name) == 0) return scenario.name;
  return "";
}

/// The mark that most of the last failures missed: what someone is stuck on. Empty: none.
Result<std::string> stuck_on(Records& records, const std::vector<AttemptRecord>& own,
                             const Scenario& scenario, Language language) {
  constexpr std::size_t kLast = 5;
  const auto values = records.metrics({own.back().person, "", scenario.name});
  ARTUS_TRY(values);
  std::map<std::string, std::vector<Metric>> metrics;
  for (const MetricValue& m : *values)
    metrics[m.attempt].push_back({m.name, m.role, m.unit, m.value, "", {}});
  std::map<std::string, int> missed;
  std::size_t looked = 0;
  for (auto a = own.rbegin(); a != own.rend() && looked < kLast; ++a) {
    if (a->ended.empty() || a->passed) continue;
    ++looked;
    for (const JudgedMark& mark : judge(metrics[a->id], scenario.pass, {}, false).marks)
      missed[mark.mark.metric] += mark.held ? 0 : 1;
  }
  const auto most =
      std::max_element(missed.begin(), missed.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == missed.end() || most->second == 0) return std::string();
  return metric_words(language, most->first);
}

using Groups = std::map<std::pair<std::string, std::string>, std::vector<AttemptRecord>>;

/// What a teacher decides by: for each learner the scenario of the last attempt, whether it is
/// passed, what most of its failures missed, and what is next.
Result<void> add_stuck(HtmlPage& page, Records& records, const Groups& groups) {
  const Language language = page.language();
  const std::vector<Scenario> all = offered();
  std::map<std::string, std::set<std::string>> passed;
  std::map<std::string, const std::vector<AttemptRecord>*> latest;
  for (const auto& [key, own] : groups) {
    if (key.second.empty()) continue;
    for (const AttemptRecord& a : own)
      if (a.passed) passed[key.second].insert(a.scenario);
    const auto*& last = latest[key.second];
    if (last == nullptr || last->back().started < own.back().started) last = &own;
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [person, own] : latest) {
    const std::string& name = own->back().scenario;
    const bool done = passed[person].count(name) != 0;
    std::string why;
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const Scenario& s) { return s.name == name; });
    if (!done && known != all.end()) {
      auto told = stuck_on(records, *own, *known, language);
      ARTUS_TRY(told);
      why = *told;
    }
    const std::string next = done ? next_of(all, passed[person]) : name;
    rows.push_back({person, title_of(all, name, language), std::to_string(own->size()),
                    done          ? translate(page, "passed")
                    : why.empty() ? "-"
                                  : why,
                    next.empty() ? "-" : title_of(all, next, language)});
  }
  page.heading(translate(page, "Where each one stands"));
  page.table({{translate(page, "learner"), ""},
              {translate(page, "last task"), "", true},
              {translate(page, "attempts"), translate(page, "unfinished and aided ones, too")},
              {translate(page, "stuck on"),
               translate(page, "the mark that most of the last five failures missed"), true},
              {translate(page, "next task"), "", true}},
             rows);
  return {};
}

}  // namespace

Result<void> write_learner_page(Records& records, const std::string& person, Language language,
                                const std::filesystem::path& file) {
  const auto attempts = records.attempts({person, "", ""});
  ARTUS_TRY(attempts);
  if (attempts->empty())
    return fail(ErrorCode::not_found, "there is no attempt of this person", person);
  HtmlPage page(fill(translate(language, "Learner {}"), {person}), language);
  std::map<std::string, std::vector<AttemptRecord>> by_scenario;
  for (const AttemptRecord& a : *attempts) by_scenario[a.scenario].push_back(a);
  const std::vector<Scenario> all = offered();
  for (const auto& [name, own] : by_scenario)
    add_scenario(page, title_of(all, name, language), own);
  return write_text(file, page.text());
}

Result<void> write_cohort_page(Records& records, const std::string& cohort, Language language,
                               const std::filesystem::path& file) {
  const auto attempts = records.attempts({"", cohort, ""});
  ARTUS_TRY(attempts);
  const auto metrics = records.metrics({"", cohort, ""});
  ARTUS_TRY(metrics);
  HtmlPage page(cohort.empty() ? translate(language, "All learners")
                               : fill(translate(language, "Cohort {}"), {cohort}),
                language);
  std::map<std::pair<std::string, std::string>, std::vector<AttemptRecord>> groups;
  for (const AttemptRecord& a : *attempts) groups[{a.scenario, a.person}].push_back(a);
  std::map<std::string, std::map<std::string, std::vector<AttemptRecord>>> scenarios;
  for (const auto& [key, own] : groups)
    if (!key.second.empty()) scenarios[key.first][key.second] = own;
  const std::vector<Scenario> all = offered();
  ARTUS_TRY(add_stuck(page, records, groups));
  for (const auto& [scenario, learners] : scenarios)
    add_curve(page, title_of(all, scenario, language), count_trials(learners));
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, own] : groups) {
    std::size_t n = 0;
    const auto failed = outcomes(own, n);
    const std::span<const bool> x(failed.get(), n);
    const auto failures = std::count(x.begin(), x.end(), true);
    const Chart chart = lc_cusum(x, kRates, kLimit);
    rows.push_back({key.second.empty() ? translate(page, "(forgotten)") : key.second,
                    title_of(all, key.first, language), std::to_string(own.size()),
                    std::to_string(n - static_cast<std::size_t>(failures)),
                    chart.signal ? std::to_string(*chart.signal) : "-"});
  }
  page.heading(translate(page, "Learners"));
  page.table(
      {{translate(page, "learner"), ""},
       {translate(page, "scenario"), "", true},
       {translate(page, "attempts"), translate(page, "unfinished and aided ones, too")},
       {translate(page, "passed"), translate(page, "without aids")},
       {translate(page, "adequate at"), translate(page, "attempt at which the LC-CUSUM signals")}},
      rows);
  std::map<std::string, std::vector<double>> spread;
  for (const MetricValue& m : *metrics)
    if (m.value)
      spread[metric_words(language, m.name) + " (" + number_words(language, m.role) + ")"]
          .push_back(*m.value);
  rows.clear();
  for (const auto& [name, values] : spread)
    rows.push_back({name, std::to_string(values.size()),
                    number(language, percentile(values, 0.1).value_or(0), 2),
                    number(language, percentile(values, 0.5).value_or(0), 2),
                    number(language, percentile(values, 0.9).value_or(0), 2)});
  page.open_details(translate(page, "Numbers of all attempts"));
  page.table({{translate(page, "metric"), ""},
              {"n", ""},
              {"p10", ""},
              {translate(page, "median"), ""},
              {"p90", ""}},
             rows);
  page.close_details();
  return write_text(file, page.text());
}

}  // namespace artus
