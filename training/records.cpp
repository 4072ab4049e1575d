// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/records.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <random>
#include <utility>

#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/training/bundled_schemas.h"

namespace artus {
namespace {

/// What brings a file from one form to the next; user_version counts how many were run.
constexpr auto kMigrations = record_schemas();

constexpr const char* kMeant =
    " FROM attempt a JOIN scenario s ON s.hash = a.scenario LEFT JOIN person p ON p.id = a.person"
    " WHERE (?1 = '' OR a.person = ?1) AND (?2 = '' OR p.cohort = ?2) AND (?3 = '' OR s.name = ?3)";

void bind(SqliteStatement& s, const AttemptFilter& filter) {
  s.bind(filter.person).bind(filter.cohort).bind(filter.scenario);
}

Result<void> migrate(SqliteFile& file) {
  auto transaction = SqliteTransaction::begin(file);
  ARTUS_TRY(transaction);
  std::int64_t version = 0;
  {
    SqliteStatement ask(file, "PRAGMA user_version");
    const auto row = ask.step();
    ARTUS_TRY(row);
    version = ask.whole(0);
  }
  if (version > static_cast<std::int64_t>(kMigrations.size()))
    return fail(ErrorCode::unsupported, "the records were made by a newer artus");
  for (auto i = static_cast<std::size_t>(version); i < kMigrations.size(); ++i)
    ARTUS_TRY(file.run(std::string(kMigrations[i])));
  ARTUS_TRY(file.run("PRAGMA user_version = " + std::to_string(kMigrations.size())));
  return transaction->commit();
}

Result<std::int64_t> metric_id(SqliteFile& file, const Metric& m) {
  SqliteStatement add(file,
                      "INSERT OR IGNORE INTO metric_name(name, role, unit, definition, filter, "
                      "version) VALUES(?, ?, ?, ?, ?, ?)");
  add.bind(m.name).bind(m.role).bind(m.unit).bind(m.definition).bind(m.rule.filter);
  add.bind(std::int64_t{kMetricsVersion});
  ARTUS_TRY(add.run());
  SqliteStatement ask(file,
                      "SELECT id FROM metric_name WHERE name = ? AND role = ? AND version = ?");
  ask.bind(m.name).bind(m.role).bind(std::int64_t{kMetricsVersion});
  const auto row = ask.step();
  ARTUS_TRY(row);
  return ask.whole(0);
}

Result<void> require_row(SqliteFile& file, const char* sql, const std::string& id,
                         const std::string& what) {
  SqliteStatement ask(file, sql);
  const auto row = ask.bind(id).step();
  ARTUS_TRY(row);
  if (!*row) return fail(ErrorCode::invalid, "there is no " + what + " '" + id + "'");
  return {};
}

}  // namespace

Result<Records> Records::open(const std::filesystem::path& file) {
  auto opened = SqliteFile::open(file);
  ARTUS_TRY(opened);
  ARTUS_TRY(migrate(*opened));
  return Records(std::move(*opened));
}

Result<void> Records::add_person(const PersonRecord& person) {
  if (person.id.empty()) return fail(ErrorCode::invalid, "a person needs a pseudonym");
  if (person.role != "learner" && person.role != "teacher" && person.role != "rater")
    return fail(ErrorCode::invalid, "a person is a learner, a teacher or a rater", person.role);
  SqliteStatement add(file_, "INSERT OR IGNORE INTO person(id, role, cohort) VALUES(?, ?, ?)");
  return add.bind(person.id).bind(person.role).bind(person.cohort).run();
}

Result<std::vector<PersonRecord>> Records::persons() {
  SqliteStatement ask(file_, "SELECT id, role, cohort FROM person ORDER BY cohort, id");
  std::vector<PersonRecord> out;
  for (;;) {
    const auto row = ask.step();
    ARTUS_TRY(row);
    if (!*row) return out;
    out.push_back({ask.text(0), ask.text(1), ask.text(2)});
  }
}

Result<void> Records::forget(const std::string& person) {
  auto transaction = SqliteTransaction::begin(file_);
  ARTUS_TRY(transaction);
  ARTUS_TRY(require_row(file_, "SELECT 1 FROM person WHERE id = ?", person, "person"));
  for (const char* table : {"metric", "event", "rating", "comment"}) {
    SqliteStatement remove(file_,
                           std::string("DELETE FROM ") + table +
                               " WHERE attempt IN (SELECT id FROM attempt WHERE person = ?)");
    ARTUS_TRY(remove.bind(person).run());
  }
  SqliteStatement blank(file_, "UPDATE attempt SET folder = NULL, device = NULL WHERE person = ?");
  ARTUS_TRY(blank.bind(person).run());
  SqliteStatement own(file_, "UPDATE comment SET text = '' WHERE person = ?");
  ARTUS_TRY(own.bind(person).run());
  SqliteStatement gone(file_, "DELETE FROM person WHERE id = ?");
  ARTUS_TRY(gone.bind(person).run());
  return transaction->commit();
}

Result<void> Records::begin(const AttemptRecord& a, const std::string& scenario_text) {
  auto transaction = SqliteTransaction::begin(file_);
  ARTUS_TRY(transaction);
  ARTUS_TRY(require_row(file_, "SELECT 1 FROM person WHERE id = ?", a.person, "person"));
  SqliteStatement scenario(file_,
                           "INSERT OR IGNORE INTO scenario(hash, name, level, toml) "
                           "VALUES(?, ?, ?, ?)");
  scenario.bind(a.scenario_hash).bind(a.scenario).bind(std::int64_t{a.level}).bind(scenario_text);
  ARTUS_TRY(scenario.run());
  SqliteStatement add(file_,
                      "INSERT INTO attempt(id, person, scenario, started, mode, aided, device, "
                      "seed, folder) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  add.bind(a.id).bind(a.person).bind(a.scenario_hash).bind(a.started).bind(a.mode);
  add.bind(std::int64_t{a.aided}).bind(a.device).bind(static_cast<std::int64_t>(a.seed));
  ARTUS_TRY(add.bind(a.folder).run());
  return transaction->commit();
}

Result<void> Records::finish(const AttemptRecord& a, std::span<const Metric> metrics,
                             std::span<const AttemptEvent> events) {
  auto transaction = SqliteTransaction::begin(file_);
  ARTUS_TRY(transaction);
  ARTUS_TRY(require_row(file_, "SELECT 1 FROM attempt WHERE id = ?", a.id, "attempt"));
  SqliteStatement end(file_,
                      "UPDATE attempt SET ended = ?, duration = ?, passed = ?, score = ? "
                      "WHERE id = ?");
  end.bind(a.ended).bind(a.duration).bind(std::int64_t{a.passed}).bind(a.score).bind(a.id);
  ARTUS_TRY(end.run());
  SqliteStatement put(file_, "INSERT OR REPLACE INTO metric(attempt, name, value) VALUES(?, ?, ?)");
  for (const Metric& m : metrics) {
    const auto id = metric_id(file_, m);
    ARTUS_TRY(id);
    ARTUS_TRY(put.bind(a.id).bind(*id).bind(m.value).run());
  }
  SqliteStatement note(file_,
                       "INSERT INTO event(attempt, t, kind, region, value, text) "
                       "VALUES(?, ?, ?, ?, ?, ?)");
  for (const AttemptEvent& e : events) {
    note.bind(a.id).bind(e.time).bind(e.kind).bind(e.region).bind(e.value).bind(e.text);
    ARTUS_TRY(note.run());
  }
  return transaction->commit();
}

Result<std::vector<AttemptRecord>> Records::attempts(const AttemptFilter& filter) {
  SqliteStatement ask(file_,
                      std::string("SELECT a.id, a.person, s.name, s.hash, s.level, a.started, "
                                  "a.ended, a.mode, a.aided, a.device, a.seed, a.folder, "
                                  "a.duration, a.passed, a.score") +
                          kMeant + " ORDER BY a.started, a.rowid");
  bind(ask, filter);
  std::vector<AttemptRecord> out;
  for (;;) {
    const auto row = ask.step();
    ARTUS_TRY(row);
    if (!*row) return out;
    AttemptRecord a;
    a.id = ask.text(0);
    a.person = ask.text(1);
    a.scenario = ask.text(2);
    a.scenario_hash = ask.text(3);
    a.level = static_cast<int>(ask.whole(4));
    a.started = ask.text(5);
    a.ended = ask.text(6);
    a.mode = ask.text(7);
    a.aided = ask.whole(8) != 0;
    a.device = ask.text(9);
    a.seed = static_cast<std::uint64_t>(ask.whole(10));
    a.folder = ask.text(11);
    a.duration = ask.number(12);
    a.passed = ask.whole(13) != 0;
    a.score = ask.number(14);
    out.push_back(std::move(a));
  }
}

Result<std::vector<MetricValue>> Records::metrics(const AttemptFilter& filter) {
  SqliteStatement ask(file_,
                      std::string("SELECT m.attempt, n.name, n.role, n.unit, m.value FROM metric m "
                                  "JOIN metric_name n ON n.id = m.name WHERE m.attempt IN "
                                  "(SELECT a.id") +
                          kMeant + ") ORDER BY m.attempt, n.id");
  bind(ask, filter);
  std::vector<MetricValue> out;
  for (;;) {
    const auto row = ask.step();
    ARTUS_TRY(row);
    if (!*row) return out;
    MetricValue value{ask.text(0), ask.text(1), ask.text(2), ask.text(3), std::nullopt};
    if (!ask.is_null(4)) value.value = ask.number(4);
    out.push_back(std::move(value));
  }
}

Result<std::vector<AttemptEvent>> Records::events(const std::string& attempt) {
  SqliteStatement ask(
      file_, "SELECT t, kind, region, value, text FROM event WHERE attempt = ? ORDER BY t, rowid");
  ask.bind(attempt);
  std::vector<AttemptEvent> out;
  for (;;) {
    const auto row = ask.step();
    ARTUS_TRY(row);
    if (!*row) return out;
    out.push_back({ask.number(0), ask.text(1), ask.text(2), ask.number(3), ask.text(4)});
  }
}

Result<void> Records::rate(const RatingRecord& r) {
  auto transaction = SqliteTransaction::begin(file_);
  ARTUS_TRY(transaction);
  ARTUS_TRY(require_row(file_, "SELECT 1 FROM attempt WHERE id = ?", r.attempt, "attempt"));
  ARTUS_TRY(
      require_row(file_, "SELECT 1 FROM person WHERE role = 'rater' AND id = ?", r.rater, "rater"));
  SqliteStatement add(file_,
                      "INSERT INTO rating(attempt, rater, instrument, item, value, blinded, at) "
                      "VALUES(?, ?, ?, ?, ?, ?, ?)");
  add.bind(r.attempt).bind(r.rater).bind(r.instrument).bind(r.item).bind(r.value);
  ARTUS_TRY(add.bind(std::int64_t{r.blinded}).bind(utc_now()).run());
  return transaction->commit();
}

Result<std::vector<AttemptRecord>> Records::unrated(const std::string& rater,
                                                    const std::string& instrument) {
  ARTUS_TRY(
      require_row(file_, "SELECT 1 FROM person WHERE role = 'rater' AND id = ?", rater, "rater"));
  SqliteStatement ask(file_,
                      "SELECT a.id, s.name, a.folder FROM attempt a JOIN scenario s ON s.hash = "
                      "a.scenario WHERE a.ended IS NOT NULL AND a.folder IS NOT NULL AND a.folder "
                      "<> '' AND NOT EXISTS(SELECT 1 FROM rating r WHERE r.attempt = a.id AND "
                      "r.rater = ?1 AND r.instrument = ?2)");
  ask.bind(rater).bind(instrument);
  std::vector<AttemptRecord> out;
  for (;;) {
    const auto row = ask.step();
    ARTUS_TRY(row);
    if (!*row) break;
    AttemptRecord attempt;
    attempt.id = ask.text(0);
    attempt.scenario = ask.text(1);
    attempt.folder = ask.text(2);
    out.push_back(std::move(attempt));
  }
  std::sort(out.begin(), out.end(), [&](const AttemptRecord& a, const AttemptRecord& b) {
    return text_hash(rater + a.id) < text_hash(rater + b.id);
  });
  return out;
}

Result<void> Records::set_norms(const std::string& scenario_hash, const std::string& group,
                                std::span<const Norm> norms) {
  auto transaction = SqliteTransaction::begin(file_);
  ARTUS_TRY(transaction);
  SqliteStatement former(file_, "DELETE FROM norm WHERE scenario = ? AND grp = ?");
  ARTUS_TRY(former.bind(scenario_hash).bind(group).run());
  SqliteStatement add(file_,
                      "INSERT INTO norm(scenario, grp, metric, role, unit, version, n, mean, sd, "
                      "p10, p50, p90) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const Norm& norm : norms) {
    add.bind(scenario_hash).bind(group).bind(norm.metric).bind(norm.role).bind(norm.unit);
    add.bind(std::int64_t{kMetricsVersion}).bind(std::int64_t{norm.n}).bind(norm.mean);
    ARTUS_TRY(add.bind(norm.sd).bind(norm.p10).bind(norm.p50).bind(norm.p90).run());
  }
  return transaction->commit();
}

Result<std::vector<Norm>> Records::norms(const std::string& scenario_hash,
                                         const std::string& group) {
  SqliteStatement ask(file_,
                      "SELECT metric, role, unit, n, mean, sd, p10, p50, p90 FROM norm WHERE "
                      "scenario = ? AND grp = ? AND version = ? ORDER BY role, metric");
  ask.bind(scenario_hash).bind(group).bind(std::int64_t{kMetricsVersion});
  std::vector<Norm> out;
  for (;;) {
    const auto row = ask.step();
    ARTUS_TRY(row);
    if (!*row) return out;
    out.push_back({ask.text(0), ask.text(1), ask.text(2), static_cast<int>(ask.whole(3)),
                   ask.number(4), ask.number(5), ask.number(6), ask.number(7), ask.number(8)});
  }
}

Result<std::vector<RatingRecord>> Records::ratings(const std::string& attempt) {
  SqliteStatement ask(file_,
                      "SELECT attempt, rater, instrument, item, value, blinded FROM rating "
                      "WHERE ?1 = '' OR attempt = ?1 ORDER BY rowid");
  ask.bind(attempt);
  std::vector<RatingRecord> out;
  for (;;) {
    const auto row = ask.step();
    ARTUS_TRY(row);
    if (!*row) return out;
    out.push_back(
        {ask.text(0), ask.text(1), ask.text(2), ask.text(3), ask.number(4), ask.whole(5) != 0});
  }
}

Result<void> Records::comment(const std::string& attempt, const std::string& person, double time,
                              const std::string& text) {
  ARTUS_TRY(require_row(file_, "SELECT 1 FROM attempt WHERE id = ?", attempt, "attempt"));
  SqliteStatement add(file_, "INSERT INTO comment(attempt, person, t, text) VALUES(?, ?, ?, ?)");
  return add.bind(attempt).bind(person).bind(time).bind(text).run();
}

Result<std::vector<CommentRecord>> Records::comments(const std::string& attempt) {
  SqliteStatement ask(file_,
                      "SELECT attempt, person, t, text FROM comment "
                      "WHERE ?1 = '' OR attempt = ?1 ORDER BY rowid");
  ask.bind(attempt);
  std::vector<CommentRecord> out;
  for (;;) {
    const auto row = ask.step();
    ARTUS_TRY(row);
    if (!*row) return out;
    out.push_back({ask.text(0), ask.text(1), ask.number(2), ask.text(3)});
  }
}

std::string make_random_id() {
  std::random_device random;
  return printed("%08x%08x", random(), random());
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 24> text{};
  static_cast<void>(std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts));
  return text.data();
}

std::string text_hash(std::string_view text) {
  return in_hexadecimal(hash_bytes(text));
}

}  // namespace artus
