// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "artus/detail/training/metrics/attempt_meter.h"
#include "artus/detail/training/scenario.h"

namespace SQLite {
class Database;
}

namespace artus {

/// A person as the records know one: by a pseudonym. Whose it is stays with the school.
struct PersonRecord {
  std::string id;
  std::string role = "learner";  ///< learner, teacher or rater
  std::string cohort;
};

/// An attempt. One that was begun and never finished has no `ended`.
struct AttemptRecord {
  std::string id;
  std::string person;
  std::string scenario;       ///< name
  std::string scenario_hash;  ///< 16 hex digits over its text
  int level = 0;
  std::string started;         ///< UTC, 2026-01-31T12:00:00Z
  std::string ended;           ///< UTC; empty: unfinished
  std::string mode = "train";  ///< train, test or demo
  bool aided = false;
  std::string device;
  std::uint64_t seed = 0;
  std::string folder;
  double duration = 0;  ///< s
  bool passed = false;
  double score = 0;
};

/// A rating of a person on an attempt.
struct RatingRecord {
  std::string attempt;
  std::string rater;
  std::string instrument;
  std::string item;
  double value = 0;
  bool blinded = true;
};

/// What somebody wrote about an attempt.
struct CommentRecord {
  std::string attempt;
  std::string person;
  double time = 0;  ///< s into the attempt
  std::string text;
};

/// One value of one metric over a set of attempts.
struct MetricValue {
  std::string attempt;
  std::string name;
  std::string role;
  std::string unit;
  std::optional<double> value;
};

/// What a group does in a scenario, of one metric.
struct Norm {
  std::string metric;
  std::string role;
  std::string unit;
  int n = 0;  ///< attempts
  double mean = 0;
  double sd = 0;
  double p10 = 0;
  double p50 = 0;
  double p90 = 0;
};

/// Which attempts are meant; empty texts: all.
struct AttemptFilter {
  std::string person;
  std::string cohort;
  std::string scenario;
};

/// Persons, attempts, metrics, events, ratings and comments in one file. Every call is one
/// transaction: a killed program loses nothing that was finished. Two programs may use one file;
/// one waits up to 10 s for the other. Errors of every call: unreadable (no permission, a read-only
/// folder, no space, in use), corrupt (no database), invalid where a name is not known; `where` is
/// the file.
class Records {
 public:
  ~Records();
  Records(Records&& other) noexcept;
  Records& operator=(Records&& other) noexcept;

  /// Opens or makes the file and brings an older one to the present form. Errors: unsupported (made
  /// by a newer artus). `patience_ms`: how long another program that holds the file is waited for.
  static constexpr int kPatience = 10000;  ///< ms
  [[nodiscard]] static Result<Records> open(const std::filesystem::path& file,
                                            int patience_ms = kPatience);

  [[nodiscard]] Result<void> add_person(const PersonRecord& person);
  [[nodiscard]] Result<std::vector<PersonRecord>> persons();
  /// Removes the person with all attempts' details; of an attempt stays that there was one.
  [[nodiscard]] Result<void> forget(const std::string& person);

  /// Notes that an attempt has begun: it shows as unfinished until finish().
  [[nodiscard]] Result<void> begin(const AttemptRecord& attempt, const std::string& scenario_text);
  [[nodiscard]] Result<void> finish(const AttemptRecord& attempt, std::span<const Metric> metrics,
                                    std::span<const AttemptEvent> events);
  /// By start.
  [[nodiscard]] Result<std::vector<AttemptRecord>> attempts(const AttemptFilter& filter = {});
  /// Of all attempts that `filter` means; newest version of each.
  [[nodiscard]] Result<std::vector<MetricValue>> metrics(const AttemptFilter& filter = {});
  [[nodiscard]] Result<std::vector<AttemptEvent>> events(const std::string& attempt);

  /// In the place of those that the group had in this scenario (hash of its text).
  [[nodiscard]] Result<void> set_norms(const std::string& scenario_hash, const std::string& group,
                                       std::span<const Norm> norms);
  /// By role and name; empty when there are none.
  [[nodiscard]] Result<std::vector<Norm>> norms(const std::string& scenario_hash,
                                                const std::string& group);

  /// Finished attempts that `rater` has not rated with `instrument`, in an order that tells nothing
  /// and is the rater's own; without who did them, when, and how they ended.
  [[nodiscard]] Result<std::vector<AttemptRecord>> unrated(const std::string& rater,
                                                           const std::string& instrument);
  [[nodiscard]] Result<void> rate(const RatingRecord& rating);
  [[nodiscard]] Result<std::vector<RatingRecord>> ratings(const std::string& attempt);
  /// Those of one attempt; of all when it is empty. By the time at which they were given.
  [[nodiscard]] Result<std::vector<CommentRecord>> comments(const std::string& attempt);
  [[nodiscard]] Result<void> comment(const std::string& attempt, const std::string& person,
                                     double time, const std::string& text);

 private:
  explicit Records(std::unique_ptr<SQLite::Database> db);
  std::unique_ptr<SQLite::Database> db_;
};

/// 16 random hex digits, for pseudonyms and attempts.
[[nodiscard]] std::string make_random_id();
/// Now, UTC.
[[nodiscard]] std::string utc_now();
/// 16 hex digits over a text.
[[nodiscard]] std::string text_hash(std::string_view text);

}  // namespace artus
