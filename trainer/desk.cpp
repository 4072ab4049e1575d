// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/desk.h"

#include <algorithm>
#include <utility>

#include "artus/detail/training/norms.h"
#include "artus/detail/training/past_attempts.h"
#include "artus/detail/training/pseudonym.h"

namespace artus {
Result<TrainDesk> TrainDesk::open(const std::filesystem::path& records,
                                  std::filesystem::path attempts) {
  std::error_code error;
  if (records.has_parent_path()) std::filesystem::create_directories(records.parent_path(), error);
  constexpr int kPatience = 1000;  // ms: who waits is told, and tries again
  auto file = Records::open(records, kPatience);
  ARTUS_TRY(file);
  return TrainDesk(std::move(*file), std::move(attempts));
}

Result<std::vector<std::string>> TrainDesk::learners() {
  const auto persons = records_.persons();
  ARTUS_TRY(persons);
  std::vector<std::string> names;
  for (const PersonRecord& person : *persons)
    if (person.role == "learner") names.push_back(person.id);
  return names;
}

Result<std::string> TrainDesk::add_learner(const std::string& cohort) {
  const auto persons = records_.persons();
  ARTUS_TRY(persons);
  PersonRecord person;
  person.cohort = cohort;
  person.id = make_pseudonym(*persons);
  ARTUS_TRY(records_.add_person(person));
  return person.id;
}

Result<TrainTally> TrainDesk::tally(const std::string& person, const std::string& scenario) {
  constexpr double kAllMarks = 100 - 1e-9;  // a score whose every mark held
  const auto attempts = records_.attempts({person, "", scenario});
  ARTUS_TRY(attempts);
  TrainTally tally;
  for (const AttemptRecord& attempt : *attempts) {
    if (attempt.ended.empty()) continue;
    ++tally.attempts;
    tally.passes += attempt.passed ? 1 : 0;
    tally.successes += attempt.score >= kAllMarks ? 1 : 0;
    tally.best = std::max(tally.best, attempt.score);
    tally.last = std::max(tally.last, attempt.started);
  }
  return tally;
}

Result<std::vector<AttemptRecord>> TrainDesk::finished(const std::string& person) {
  auto attempts = records_.attempts({person, "", ""});
  ARTUS_TRY(attempts);
  std::erase_if(*attempts, [](const AttemptRecord& attempt) {
    std::error_code ignored;
    return attempt.ended.empty() || attempt.folder.empty() ||
           !std::filesystem::exists(std::filesystem::path(attempt.folder) / "session.rec", ignored);
  });
  std::reverse(attempts->begin(), attempts->end());
  return attempts;
}

Result<std::vector<Norm>> TrainDesk::norms(const AttemptRecord& attempt) {
  return records_.norms(attempt.scenario_hash, kExperts);
}

Result<std::vector<AttemptEvent>> TrainDesk::events(const AttemptRecord& attempt) {
  return records_.events(attempt.id);
}

Result<std::vector<PastAttempt>> TrainDesk::before(const AttemptRecord& attempt) {
  return read_past_attempts(records_, attempt);
}

Result<AttemptRecord> TrainDesk::begin(const std::string& person, const Scenario& scenario,
                                       const std::string& device) {
  AttemptRecord attempt;
  attempt.id = make_random_id();
  attempt.person = person;
  attempt.scenario = scenario.name;
  attempt.scenario_hash = text_hash(scenario.text);
  attempt.level = scenario.level;
  attempt.started = utc_now();
  attempt.mode = scenario.aided() ? "train" : "test";
  attempt.aided = scenario.aided();
  attempt.device = device;
  attempt.seed = scenario.seed;
  const std::filesystem::path folder = std::filesystem::absolute(attempts_ / attempt.id);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return fail(ErrorCode::unreadable, "cannot make the attempt's folder: " + error.message(),
                folder.string());
  attempt.folder = folder.string();
  ARTUS_TRY(records_.begin(attempt, scenario.text));
  return attempt;
}

Result<void> TrainDesk::finish(AttemptRecord attempt, const PlayedAttempt& played) {
  attempt.ended = utc_now();
  attempt.duration = played.duration;
  attempt.passed = played.judgement.passed;
  attempt.score = played.judgement.score;
  return records_.finish(attempt, played.measures.metrics, played.measures.events);
}

Scenario with_faded_aids(Scenario scenario, const TrainTally& tally, bool wanted) {
  for (Aid& aid : scenario.aids) {
    if (!wanted)
      aid.value = 0;
    else if (scenario.fade == "success")
      aid.value = faded(aid.value, tally.successes);
    else if (scenario.fade == "trials")
      aid.value = faded(aid.value, tally.attempts);
  }
  return scenario;
}

}  // namespace artus
