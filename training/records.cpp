// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/records.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <random>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <sqlite3.h>

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

std::string advice(int code) {
  switch (code) {
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return "; check that its folder exists and may be written";
    case SQLITE_FULL:
    case SQLITE_IOERR:
      return "; check that there is space left (what was stored before is kept)";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "; another program is using it, try again";
    default:
      return "";
  }
}

/// Does `work`, which gives a Result; what SQLite throws meanwhile becomes one, too.
template <class Work>
auto guarded(const std::string& file, Work&& work) -> decltype(work()) {
  try {
    return work();
  } catch (const SQLite::Exception& e) {
    const int code = e.getErrorCode() & 0xff;
    const bool corrupt = code == SQLITE_NOTADB || code == SQLITE_CORRUPT;
    return fail(corrupt ? ErrorCode::corrupt : ErrorCode::unreadable,
                std::string("the records: ") + e.what() + advice(code), file);
  }
}

/// As `guarded`, undone unless all of `work` succeeds. Takes the right to write at once.
template <class Work>
Result<void> in_transaction(SQLite::Database& db, Work&& work) {
  return guarded(db.getFilename(), [&]() -> Result<void> {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    ARTUS_TRY(work());
    transaction.commit();
    return {};
  });
}

template <class... Values>
SQLite::Statement query(const SQLite::Database& db, const std::string& sql,
                        const Values&... values) {
  SQLite::Statement statement(db, sql);
  SQLite::bind(statement, values...);
  return statement;
}

template <class... Values>
void run(const SQLite::Database& db, const std::string& sql, const Values&... values) {
  query(db, sql, values...).exec();
}

std::string text(const SQLite::Statement& row, int column) {
  return row.getColumn(column).getString();
}
double number(const SQLite::Statement& row, int column) {
  return row.getColumn(column).getDouble();
}
std::int64_t whole(const SQLite::Statement& row, int column) {
  return row.getColumn(column).getInt64();
}

/// What `make` makes of each row.
template <class Make, class... Values>
auto all_rows(const SQLite::Database& db, Make make, const std::string& sql,
              const Values&... values) {
  using Row = decltype(make(std::declval<const SQLite::Statement&>()));
  return guarded(db.getFilename(), [&]() -> Result<std::vector<Row>> {
    auto rows = query(db, sql, values...);
    std::vector<Row> out;
    while (rows.executeStep()) out.push_back(make(rows));
    return out;
  });
}

Result<void> migrate(SQLite::Database& db) {
  return in_transaction(db, [&]() -> Result<void> {
    const std::int64_t version = db.execAndGet("PRAGMA user_version").getInt64();
    if (version > static_cast<std::int64_t>(kMigrations.size()))
      return fail(ErrorCode::unsupported, "the records were made by a newer artus",
                  db.getFilename());
    for (auto i = static_cast<std::size_t>(version); i < kMigrations.size(); ++i)
      db.exec(std::string(kMigrations[i]));
    db.exec("PRAGMA user_version = " + std::to_string(kMigrations.size()));
    return {};
  });
}

std::int64_t metric_id(const SQLite::Database& db, const Metric& m) {
  run(db,
      "INSERT OR IGNORE INTO metric_name(name, role, unit, definition, filter, version) "
      "VALUES(?, ?, ?, ?, ?, ?)",
      m.name, m.role, m.unit, m.definition, m.rule.filter, kMetricsVersion);
  auto row = query(db, "SELECT id FROM metric_name WHERE name = ? AND role = ? AND version = ?",
                   m.name, m.role, kMetricsVersion);
  row.executeStep();
  return whole(row, 0);
}

Result<void> require_row(const SQLite::Database& db, const char* sql, const std::string& id,
                         const std::string& what) {
  if (query(db, sql, id).executeStep()) return {};
  return fail(ErrorCode::invalid, "there is no " + what + " '" + id + "'", db.getFilename());
}
Result<void> require_person(const SQLite::Database& db, const std::string& id) {
  return require_row(db, "SELECT 1 FROM person WHERE id = ?", id, "person");
}
Result<void> require_rater(const SQLite::Database& db, const std::string& id) {
  auto known = require_row(db, "SELECT 1 FROM person WHERE role = 'rater' AND id = ?", id, "rater");
  if (!known)
    return fail(
        known.error().code,
        known.error().message + ": artus learners add --role rater --person " + id + " makes one",
        known.error().where);
  return known;
}
/// The form that artus knows takes its own values alone.
Result<void> require_in_form(const RatingRecord& r) {
  constexpr double kOsausLeast = 1;
  constexpr double kOsausMost = 5;
  if (r.instrument != "OSAUS" || (r.value >= kOsausLeast && r.value <= kOsausMost)) return {};
  return fail(ErrorCode::invalid, "an item of OSAUS is rated from 1 to 5", "--value");
}
Result<void> require_attempt(const SQLite::Database& db, const std::string& id) {
  return require_row(db, "SELECT 1 FROM attempt WHERE id = ?", id, "attempt");
}

}  // namespace

Records::Records(std::unique_ptr<SQLite::Database> db) : db_(std::move(db)) {}
Records::~Records() = default;
Records::Records(Records&&) noexcept = default;
Records& Records::operator=(Records&&) noexcept = default;

Result<Records> Records::open(const std::filesystem::path& file, int patience_ms) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  return guarded(file.string(), [&]() -> Result<Records> {
    auto db = std::make_unique<SQLite::Database>(
        file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, patience_ms);
    for (const char* choice : {"foreign_keys = ON", "journal_mode = WAL", "synchronous = FULL"})
      db->exec(std::string("PRAGMA ") + choice);
    ARTUS_TRY(migrate(*db));
    return Records(std::move(db));
  });
}

Result<void> Records::add_person(const PersonRecord& person) {
  if (person.id.empty()) return fail(ErrorCode::invalid, "a person needs a pseudonym");
  if (person.role != "learner" && person.role != "teacher" && person.role != "rater")
    return fail(ErrorCode::invalid, "the role must be learner, teacher or rater", person.role);
  return in_transaction(*db_, [&]() -> Result<void> {
    run(*db_, "INSERT OR IGNORE INTO person(id, role, cohort) VALUES(?, ?, ?)", person.id,
        person.role, person.cohort);
    return {};
  });
}

Result<std::vector<PersonRecord>> Records::persons() {
  return all_rows(
      *db_,
      [](const auto& row) {
        return PersonRecord{text(row, 0), text(row, 1), text(row, 2)};
      },
      "SELECT id, role, cohort FROM person ORDER BY cohort, id");
}

Result<void> Records::forget(const std::string& person) {
  return in_transaction(*db_, [&]() -> Result<void> {
    ARTUS_TRY(require_person(*db_, person));
    for (const char* table : {"metric", "event", "rating", "comment"})
      run(*db_,
          std::string("DELETE FROM ") + table +
              " WHERE attempt IN (SELECT id FROM attempt WHERE person = ?)",
          person);
    run(*db_, "UPDATE attempt SET folder = NULL, device = NULL WHERE person = ?", person);
    run(*db_, "UPDATE comment SET text = '' WHERE person = ?", person);
    run(*db_, "DELETE FROM person WHERE id = ?", person);
    return {};
  });
}

Result<void> Records::begin(const AttemptRecord& a, const std::string& scenario_text) {
  return in_transaction(*db_, [&]() -> Result<void> {
    ARTUS_TRY(require_person(*db_, a.person));
    run(*db_, "INSERT OR IGNORE INTO scenario(hash, name, level, toml) VALUES(?, ?, ?, ?)",
        a.scenario_hash, a.scenario, a.level, scenario_text);
    run(*db_,
        "INSERT INTO attempt(id, person, scenario, started, mode, aided, device, seed, folder) "
        "VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)",
        a.id, a.person, a.scenario_hash, a.started, a.mode, int{a.aided}, a.device,
        static_cast<std::int64_t>(a.seed), a.folder);
    return {};
  });
}

Result<void> Records::finish(const AttemptRecord& a, std::span<const Metric> metrics,
                             std::span<const AttemptEvent> events) {
  return in_transaction(*db_, [&]() -> Result<void> {
    ARTUS_TRY(require_attempt(*db_, a.id));
    run(*db_,
        "UPDATE attempt SET ended = ?, duration = ?, passed = ?, score = ?, aided = ? WHERE id = ?",
        a.ended, a.duration, int{a.passed}, a.score, int{a.aided}, a.id);
    for (const Metric& m : metrics) {
      auto put = query(*db_, "INSERT OR REPLACE INTO metric(attempt, name, value) VALUES(?, ?, ?)",
                       a.id, metric_id(*db_, m));
      if (m.value) put.bind(3, *m.value);  // else NULL
      put.exec();
    }
    for (const AttemptEvent& e : events)
      run(*db_, "INSERT INTO event(attempt, t, kind, region, value, text) VALUES(?, ?, ?, ?, ?, ?)",
          a.id, e.time, e.kind, e.region, e.value, e.text);
    return {};
  });
}

Result<std::vector<AttemptRecord>> Records::attempts(const AttemptFilter& filter) {
  const auto make = [](const SQLite::Statement& row) {
    AttemptRecord a;
    a.id = text(row, 0);
    a.person = text(row, 1);
    a.scenario = text(row, 2);
    a.scenario_hash = text(row, 3);
    a.level = static_cast<int>(whole(row, 4));
    a.started = text(row, 5);
    a.ended = text(row, 6);
    a.mode = text(row, 7);
    a.aided = whole(row, 8) != 0;
    a.device = text(row, 9);
    a.seed = static_cast<std::uint64_t>(whole(row, 10));
    a.folder = text(row, 11);
    a.duration = number(row, 12);
    a.passed = whole(row, 13) != 0;
    a.score = number(row, 14);
    return a;
  };
  return all_rows(*db_, make,
                  std::string("SELECT a.id, a.person, s.name, s.hash, s.level, a.started, a.ended, "
                              "a.mode, a.aided, a.device, a.seed, a.folder, a.duration, a.passed, "
                              "a.score") +
                      kMeant + " ORDER BY a.started, a.rowid",
                  filter.person, filter.cohort, filter.scenario);
}

Result<std::vector<MetricValue>> Records::metrics(const AttemptFilter& filter) {
  const auto make = [](const SQLite::Statement& row) {
    MetricValue value{text(row, 0), text(row, 1), text(row, 2), text(row, 3), std::nullopt};
    if (!row.getColumn(4).isNull()) value.value = number(row, 4);
    return value;
  };
  return all_rows(*db_, make,
                  std::string("SELECT m.attempt, n.name, n.role, n.unit, m.value FROM metric m "
                              "JOIN metric_name n ON n.id = m.name WHERE m.attempt IN "
                              "(SELECT a.id") +
                      kMeant + ") ORDER BY m.attempt, n.id",
                  filter.person, filter.cohort, filter.scenario);
}

Result<std::vector<AttemptEvent>> Records::events(const std::string& attempt) {
  const auto make = [](const SQLite::Statement& row) {
    return AttemptEvent{number(row, 0), text(row, 1), text(row, 2), number(row, 3), text(row, 4)};
  };
  return all_rows(
      *db_, make,
      "SELECT t, kind, region, value, text FROM event WHERE attempt = ? ORDER BY t, rowid",
      attempt);
}

Result<void> Records::rate(const RatingRecord& r) {
  return in_transaction(*db_, [&]() -> Result<void> {
    ARTUS_TRY(require_attempt(*db_, r.attempt));
    ARTUS_TRY(require_rater(*db_, r.rater));
    ARTUS_TRY(require_in_form(r));
    run(*db_,
        "INSERT INTO rating(attempt, rater, instrument, item, value, blinded, at) "
        "VALUES(?, ?, ?, ?, ?, ?, ?)",
        r.attempt, r.rater, r.instrument, r.item, r.value, int{r.blinded}, utc_now());
    return {};
  });
}

Result<std::vector<AttemptRecord>> Records::unrated(const std::string& rater,
                                                    const std::string& instrument) {
  ARTUS_TRY(guarded(db_->getFilename(), [&] { return require_rater(*db_, rater); }));
  const auto make = [](const SQLite::Statement& row) {
    AttemptRecord attempt;
    attempt.id = text(row, 0);
    attempt.scenario = text(row, 1);
    attempt.folder = text(row, 2);
    return attempt;
  };
  auto out = all_rows(
      *db_, make,
      "SELECT a.id, s.name, a.folder FROM attempt a JOIN scenario s ON s.hash = a.scenario "
      "WHERE a.ended IS NOT NULL AND a.folder IS NOT NULL AND a.folder <> '' AND NOT EXISTS("
      "SELECT 1 FROM rating r WHERE r.attempt = a.id AND r.rater = ?1 AND r.instrument = ?2)",
      rater, instrument);
  ARTUS_TRY(out);
  std::sort(out->begin(), out->end(), [&](const AttemptRecord& a, const AttemptRecord& b) {
    return text_hash(rater + a.id) < text_hash(rater + b.id);
  });
  return out;
}

Result<void> Records::set_norms(const std::string& scenario_hash, const std::string& group,
                                std::span<const Norm> norms) {
  return in_transaction(*db_, [&]() -> Result<void> {
    run(*db_, "DELETE FROM norm WHERE scenario = ? AND grp = ?", scenario_hash, group);
    for (const Norm& norm : norms)
      run(*db_,
          "INSERT INTO norm(scenario, grp, metric, role, unit, version, n, mean, sd, p10, p50, "
          "p90) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
          scenario_hash, group, norm.metric, norm.role, norm.unit, kMetricsVersion, norm.n,
          norm.mean, norm.sd, norm.p10, norm.p50, norm.p90);
    return {};
  });
}

Result<std::vector<Norm>> Records::norms(const std::string& scenario_hash,
                                         const std::string& group) {
  const auto make = [](const SQLite::Statement& row) {
    return Norm{text(row, 0),   text(row, 1),   text(row, 2),   static_cast<int>(whole(row, 3)),
                number(row, 4), number(row, 5), number(row, 6), number(row, 7),
                number(row, 8)};
  };
  return all_rows(*db_, make,
                  "SELECT metric, role, unit, n, mean, sd, p10, p50, p90 FROM norm WHERE "
                  "scenario = ? AND grp = ? AND version = ? ORDER BY role, metric",
                  scenario_hash, group, kMetricsVersion);
}

Result<std::vector<RatingRecord>> Records::ratings(const std::string& attempt) {
  const auto make = [](const SQLite::Statement& row) {
    return RatingRecord{text(row, 0), text(row, 1),   text(row, 2),
                        text(row, 3), number(row, 4), whole(row, 5) != 0};
  };
  return all_rows(*db_, make,
                  "SELECT attempt, rater, instrument, item, value, blinded FROM rating "
                  "WHERE ?1 = '' OR attempt = ?1 ORDER BY rowid",
                  attempt);
}

Result<void> Records::comment(const std::string& attempt, const std::string& person, double time,
                              const std::string& text) {
  return in_transaction(*db_, [&]() -> Result<void> {
    ARTUS_TRY(require_attempt(*db_, attempt));
    run(*db_, "INSERT INTO comment(attempt, person, t, text) VALUES(?, ?, ?, ?)", attempt, person,
        time, text);
    return {};
  });
}

Result<std::vector<CommentRecord>> Records::comments(const std::string& attempt) {
  const auto make = [](const SQLite::Statement& row) {
    return CommentRecord{text(row, 0), text(row, 1), number(row, 2), text(row, 3)};
  };
  return all_rows(*db_, make,
                  "SELECT attempt, person, t, text FROM comment "
                  "WHERE ?1 = '' OR attempt = ?1 ORDER BY rowid",
                  attempt);
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
