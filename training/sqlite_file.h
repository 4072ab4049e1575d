// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "artus/core/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace artus {

/// An SQLite database file: opened or refused; each failure says what to do.
class SqliteFile {
 public:
  /// Opens or makes it; write-ahead log, foreign keys on, others waited for up to 10 s. Errors:
  /// unreadable (no permission, a read-only folder, no space), corrupt (no database).
  [[nodiscard]] static Result<SqliteFile> open(const std::filesystem::path& file);

  /// Runs statements that return no rows.
  [[nodiscard]] Result<void> run(const std::string& sql);
  /// The failure of the last call.
  [[nodiscard]] tl::unexpected<Error> failure() const;
  [[nodiscard]] sqlite3* handle() const noexcept { return db_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* db) const noexcept;
  };
  std::unique_ptr<sqlite3, Close> db_;
  std::string file_;
};

/// One prepared statement: bind in order, then step.
class SqliteStatement {
 public:
  SqliteStatement(SqliteFile& file, std::string_view sql);

  SqliteStatement& bind(std::string_view text);
  SqliteStatement& bind(std::int64_t value);
  SqliteStatement& bind(double value);
  SqliteStatement& bind(const std::optional<double>& value);
  SqliteStatement& bind_null();

  /// True while there is a row. Errors: those of the database; what was bound is bound anew after
  /// the last row.
  [[nodiscard]] Result<bool> step();
  /// A step that gives no row.
  [[nodiscard]] Result<void> run();

  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::int64_t whole(int column) const;
  [[nodiscard]] double number(int column) const;
  [[nodiscard]] bool is_null(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  SqliteFile& file_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int next_ = 1;
};

/// A transaction: undone unless committed.
class SqliteTransaction {
 public:
  /// Errors: those of the database; takes the right to write at once.
  [[nodiscard]] static Result<SqliteTransaction> begin(SqliteFile& file);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  SqliteTransaction(SqliteTransaction&& other) noexcept;
  SqliteTransaction& operator=(SqliteTransaction&&) = delete;
  [[nodiscard]] Result<void> commit();

 private:
  explicit SqliteTransaction(SqliteFile& file) : file_(&file) {}
  SqliteFile* file_;
};

}  // namespace artus
