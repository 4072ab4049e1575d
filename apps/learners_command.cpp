// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/options/window_options.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/reports/attempt_page.h"
#include "artus/detail/reports/logbook_page.h"
#include "artus/detail/training/judgement.h"
#include "artus/detail/training/norms.h"
#include "artus/detail/training/pseudonym.h"
#include "artus/detail/training/record_export.h"

namespace artus {
namespace {

struct LearnersOptions {
  std::string what;
  std::string person;
  std::filesystem::path records;
  std::string role = "learner";
  std::string cohort;
  std::string scenario;
  std::string format = "csv";
  std::string home = "https://example.org";
  std::filesystem::path out;
  std::string language;  // of the report
  bool json = false;
};

/// The folders of a person's attempts that stand where this program wrote them.
void remove_folders(const std::vector<AttemptRecord>& attempts) {
  for (const AttemptRecord& a : attempts) {
    if (a.folder.empty()) continue;
    std::error_code ignored;
    for (const char* file : {"session.rec", "scenario.toml", "attempt.json", "report.html"})
      std::filesystem::remove(std::filesystem::path(a.folder) / file, ignored);
    std::filesystem::remove(a.folder, ignored);  // only when nothing else is in it
  }
}

Result<void> show(Records& records, const LearnersOptions& options) {
  const auto attempts = records.attempts({options.person, options.cohort, options.scenario});
  ARTUS_TRY(attempts);
  if (options.json) {
    const auto json = export_json(records, {options.person, options.cohort, options.scenario});
    ARTUS_TRY(json);
    std::cout << json->dump(2) << '\n';
    return {};
  }
  for (const AttemptRecord& a : *attempts)
    std::printf("%s  %s  %-16s %-18s %s  score %d%s\n", a.id.c_str(), a.started.c_str(),
                a.person.empty() ? "(forgotten)" : a.person.c_str(), a.scenario.c_str(),
                a.ended.empty() ? "unfinished" : (a.passed ? "passed" : "failed"),
                whole_points(a.score), a.aided ? "  with aids" : "");
  return {};
}

Result<void> list(Records& records, const LearnersOptions& options) {
  const auto persons = records.persons();
  ARTUS_TRY(persons);
  const auto attempts = records.attempts();
  ARTUS_TRY(attempts);
  auto json = nlohmann::json::array();
  for (const PersonRecord& p : *persons) {
    int total = 0;
    int passed = 0;
    int unfinished = 0;
    for (const AttemptRecord& a : *attempts) {
      if (a.person != p.id) continue;
      ++total;
      passed += a.passed ? 1 : 0;
      unfinished += a.ended.empty() ? 1 : 0;
    }
    if (options.json)
      json.push_back({{"person", p.id},
                      {"role", p.role},
                      {"cohort", p.cohort},
                      {"attempts", total},
                      {"passed", passed},
                      {"unfinished", unfinished}});
    else
      std::printf("%-18s %-8s %-12s %4d %s, %d passed, %d unfinished\n", p.id.c_str(),
                  p.role.c_str(), p.cohort.c_str(), total, total == 1 ? "attempt" : "attempts",
                  passed, unfinished);
  }
  if (options.json) std::cout << json.dump(2) << '\n';
  return {};
}

Result<void> add(Records& records, const LearnersOptions& options) {
  const auto persons = records.persons();
  ARTUS_TRY(persons);
  const std::string id = options.person.empty() ? make_pseudonym(*persons) : options.person;
  ARTUS_TRY(records.add_person({id, options.role, options.cohort}));
  std::printf("%s\n", id.c_str());
  return {};
}

Result<void> export_all(Records& records, const LearnersOptions& options) {
  const AttemptFilter filter{options.person, options.cohort, options.scenario};
  Result<std::string> text;
  if (options.format == "csv")
    text = export_csv(records, filter);
  else if (options.format == "tsv")
    text = export_tsv(records, filter);
  else
    text = (options.format == "json" ? export_json(records, filter)
                                     : export_xapi(records, filter, options.home))
               .map([](const nlohmann::json& json) { return json.dump(2) + "\n"; });
  ARTUS_TRY(text);
  if (!options.out.empty()) return write_text(options.out, *text);
  std::fputs(text->c_str(), stdout);
  return {};
}

Result<void> report(Records& records, const LearnersOptions& options) {
  if (options.out.empty()) return fail(ErrorCode::malformed, "name the page to write", "--out");
  const Language language = language_of(options.language);
  return options.person.empty()
             ? write_cohort_page(records, options.cohort, language, options.out)
             : write_learner_page(records, options.person, language, options.out);
}

Result<void> logbook(Records& records, const LearnersOptions& options) {
  if (options.out.empty()) return fail(ErrorCode::malformed, "name the page to write", "--out");
  if (options.person.empty()) return fail(ErrorCode::malformed, "name the person", "--person");
  return write_logbook_page(records, options.person, utc_now(), language_of(options.language),
                            options.out);
}

nlohmann::json to_json(const Norm& n) {
  return {{"metric", n.metric}, {"of", n.role},   {"unit", n.unit},
          {"attempts", n.n},    {"mean", n.mean}, {"sd", n.sd},
          {"p10", n.p10},       {"p50", n.p50},   {"p90", n.p90}};
}

Result<void> norms(Records& records, const LearnersOptions& options) {
  if (options.scenario.empty()) return fail(ErrorCode::malformed, "name it", "--scenario");
  const std::string group = options.cohort.empty() ? kExperts : options.cohort;
  const auto made = renew_norms(records, options.scenario, group);
  ARTUS_TRY(made);
  if (options.json) {
    auto json = nlohmann::json::array();
    for (const Norm& n : *made) json.push_back(to_json(n));
    std::cout << json.dump(2) << '\n';
    return {};
  }
  std::printf("%-30s %-8s %4s %10s %10s %10s %10s\n", "metric", "of", "n", "mean", "10 %", "50 %",
              "90 %");
  for (const Norm& n : *made)
    std::printf("%-30s %-8s %4d %10.3f %10.3f %10.3f %10.3f %s\n", n.metric.c_str(), n.role.c_str(),
                n.n, n.mean, n.p10, n.p50, n.p90, n.unit.c_str());
  return {};
}

Result<void> forget(Records& records, const LearnersOptions& options) {
  if (options.person.empty()) return fail(ErrorCode::malformed, "name the person", "--person");
  const auto attempts = records.attempts({options.person, "", ""});
  ARTUS_TRY(attempts);
  ARTUS_TRY(records.forget(options.person));
  remove_folders(*attempts);
  return {};
}

ExitCode run_learners(const LearnersOptions& options) {
  if (options.what.empty())
    return report_error(
        {ErrorCode::malformed,
         "say what: list, show, add, export, report, logbook, norms, forget or rate", "what"},
        options.json);
  std::error_code ignored;
  if (options.what != "add" && !std::filesystem::exists(options.records, ignored))
    return report_error(
        {ErrorCode::not_found, "there is no such file of records; artus learners add begins one",
         options.records.string()},
        options.json);
  auto records = Records::open(options.records);
  if (!records) return report_error(records.error(), options.json);
  Result<void> done;
  if (options.what == "list") done = list(*records, options);
  if (options.what == "show") done = show(*records, options);
  if (options.what == "add") done = add(*records, options);
  if (options.what == "export") done = export_all(*records, options);
  if (options.what == "report") done = report(*records, options);
  if (options.what == "logbook") done = logbook(*records, options);
  if (options.what == "norms") done = norms(*records, options);
  if (options.what == "forget") done = forget(*records, options);
  return done ? ExitCode::ok : report_error(done.error(), options.json);
}

struct RateOptions {
  std::filesystem::path records;
  RatingRecord rating;
  bool next = false;
  bool json = false;
  bool not_blinded = false;
  std::string comment;
  double time = 0;
  [[nodiscard]] bool valued() const { return !std::isnan(rating.value); }
};

/// What the rater may know of the attempt that is next.
Result<void> tell_next(Records& records, const RateOptions& options) {
  const auto left = records.unrated(options.rating.rater, options.rating.instrument);
  ARTUS_TRY(left);
  if (options.json) {
    nlohmann::json json = {{"left", left->size()}};
    if (!left->empty())
      json.update({{"attempt", left->front().id},
                   {"scenario", left->front().scenario},
                   {"folder", left->front().folder}});
    std::cout << json.dump(2) << '\n';
  } else if (left->empty()) {
    std::printf("all finished attempts are rated\n");
  } else {
    std::printf("%s  %s  %s  (%zu left)\n", left->front().id.c_str(),
                left->front().scenario.c_str(), left->front().folder.c_str(), left->size());
  }
  return {};
}

ExitCode run_rate(const RateOptions& options) {
  auto records = Records::open(options.records);
  if (!records) return report_error(records.error(), options.json);
  if (options.next) {
    const auto told = tell_next(*records, options);
    return told ? ExitCode::ok : report_error(told.error(), options.json);
  }
  if (options.rating.attempt.empty() || options.rating.item.empty() || !options.valued())
    return report_error(
        {ErrorCode::malformed,
         "a rating takes an attempt, --item and --value; --next tells which attempt is next",
         "rate"},
        options.json);
  RatingRecord rating = options.rating;
  rating.blinded = !options.not_blinded;
  if (const auto done = records->rate(rating); !done) return report_error(done.error(), false);
  if (!options.comment.empty()) {
    const auto done = records->comment(options.rating.attempt, options.rating.rater, options.time,
                                       options.comment);
    if (!done) return report_error(done.error(), false);
  }
  return ExitCode::ok;
}

}  // namespace

void add_learners_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<LearnersOptions>();
  Command* command = add_command(
      app, "learners",
      "Persons and their attempts: list, show, add, export, report, logbook, norms, forget",
      "Persons are pseudonyms; whose they are stays with the school. forget removes a person, the\n"
      "details of all attempts and their folders; that there were attempts stays. norms computes\n"
      "what a cohort does in a scenario; that of 'experts' stands in every report beside the\n"
      "learner's numbers. logbook writes what a person did by procedure, what is due again, and "
      "lines\n"
      "for a supervisor, to be printed.\n"
      "Examples:\n"
      "  artus learners add --records school.db --cohort 2026\n"
      "  artus learners list --records school.db\n"
      "  artus learners show --records school.db --person a1\n"
      "  artus learners export --records school.db --format xapi --home https://school.example\n"
      "  artus learners report --records school.db --person a1 --out a1.html\n"
      "  artus learners logbook --records school.db --person a1 --out logbook.html\n"
      "  artus learners norms --records school.db --scenario gel-align --cohort experts\n"
      "  artus learners forget --records school.db --person a1");
  command
      ->add_option("what", options->what,
                   "list, show, add, export, report, logbook, norms or forget")
      ->one_of({"list", "show", "add", "export", "report", "logbook", "norms", "forget"});
  command->add_option("--records", options->records, "file of the records")->required();
  command->add_option("--person", options->person, "pseudonym; add makes one when none is given");
  command->add_option("--cohort", options->cohort, "group of persons");
  command->add_option("--scenario", options->scenario, "name of a scenario");
  command->add_option("--role", options->role, "of a person that is added")
      ->one_of({"learner", "teacher", "rater"})
      ->capture_default_str();
  command->add_option("--format", options->format, "of the export")
      ->one_of({"csv", "json", "tsv", "xapi"})
      ->capture_default_str();
  command->add_option("--home", options->home, "IRI of who gave the pseudonyms, for xapi")
      ->capture_default_str();
  command->add_option("--out,-o", options->out, "file to write");
  add_language_option(command, options->language);
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_learners(*options); });
}

void add_rate_command(Command& learners, ExitCode& code) {
  auto options = std::make_shared<RateOptions>();
  options->rating.value = std::nan("");
  Command* command = add_command(
      learners, "rate", "Store a rater's judgement of an attempt",
      "Ratings stand beside the machine's numbers and never change them. --next tells which "
      "attempt\n"
      "the rater has not rated yet, in an order of the rater's own, and not whose it is.\n"
      "Examples:\n"
      "  artus learners rate --next --records school.db --rater r1 --instrument OSAUS\n"
      "  artus learners rate 0123456789abcdef --records school.db --rater r1 --instrument OSAUS "
      "\\\n"
      "    --item overall --value 4 --comment \"looked away\" --time 12.5");
  command->add_option("attempt", options->rating.attempt, "of --next, or of learners show");
  command->add_option("--records", options->records, "file of the records")->required();
  command->add_option("--rater", options->rating.rater, "a person whose role is rater")->required();
  command->add_option("--instrument", options->rating.instrument, "the form's name")->required();
  command->add_flag("--next", options->next, "tell which attempt is next, and rate none");
  command->add_option("--item", options->rating.item, "the form's item");
  command->add_option("--value", options->rating.value, "as the form counts")
      ->check(number_in(-1000, 1000));
  command->add_flag("--not-blinded", options->not_blinded, "the rater knew who, or the verdict");
  command->add_option("--comment", options->comment, "free text");
  command->add_option("--time", options->time, "s into the attempt that the comment is about")
      ->check(number_in(0, 100000));
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_rate(*options); });
}

}  // namespace artus
