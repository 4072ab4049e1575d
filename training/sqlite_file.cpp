// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/sqlite_file.h"

#include <utility>

#include <sqlite3.h>

namespace artus {
namespace {

constexpr int kPatience = 10000;  // ms

std::string advice(int code) {
  switch (code & 0xff) {
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return "; is its folder there, and may it be written?";
    case SQLITE_FULL:
    case SQLITE_IOERR:
      return "; is there space left? What was stored before is kept";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "; another program holds it, try again";
    default:
      return "";
  }
}

ErrorCode code_of(int code) {
  const int plain = code & 0xff;
  return plain == SQLITE_NOTADB || plain == SQLITE_CORRUPT ? ErrorCode::corrupt
                                                           : ErrorCode::unreadable;
}

}  // namespace

void SqliteFile::Close::operator()(sqlite3* db) const noexcept {
  sqlite3_close_v2(db);
}

Result<SqliteFile> SqliteFile::open(const std::filesystem::path& file) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  SqliteFile out;
  out.file_ = file.string();
  sqlite3* db = nullptr;
  const int opened =
      sqlite3_open_v2(file.c_str(), &db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  out.db_.reset(db);
  if (opened != SQLITE_OK) return out.failure();
  sqlite3_extended_result_codes(db, 1);
  sqlite3_busy_timeout(db, kPatience);
  ARTUS_TRY(out.run("PRAGMA foreign_keys = ON"));
  ARTUS_TRY(out.run("PRAGMA journal_mode = WAL"));
  ARTUS_TRY(out.run("PRAGMA synchronous = FULL"));
  return out;
}

tl::unexpected<Error> SqliteFile::failure() const {
  const int code = db_ ? sqlite3_extended_errcode(db_.get()) : SQLITE_NOMEM;
  const std::string what = db_ ? sqlite3_errmsg(db_.get()) : "out of memory";
  return fail(code_of(code), "the records: " + what + advice(code), file_);
}

Result<void> SqliteFile::run(const std::string& sql) {
  if (sqlite3_exec(db_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    return failure();
  return {};
}

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const noexcept {
  sqlite3_finalize(statement);
}

SqliteStatement::SqliteStatement(SqliteFile& file, std::string_view sql) : file_(file) {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(file.handle(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  statement_.reset(statement);
}

SqliteStatement& SqliteStatement::bind(std::string_view text) {
  sqlite3_bind_text(statement_.get(), next_++, text.data(), static_cast<int>(text.size()),
                    SQLITE_TRANSIENT);  // NOLINT: SQLite's own cast
  return *this;
}

SqliteStatement& SqliteStatement::bind(std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), next_++, value);
  return *this;
}

SqliteStatement& SqliteStatement::bind(double value) {
  sqlite3_bind_double(statement_.get(), next_++, value);
  return *this;
}

SqliteStatement& SqliteStatement::bind(const std::optional<double>& value) {
  return value ? bind(*value) : bind_null();
}

SqliteStatement& SqliteStatement::bind_null() {
  sqlite3_bind_null(statement_.get(), next_++);
  return *this;
}

Result<bool> SqliteStatement::step() {
  if (!statement_) return file_.failure();
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    auto error = file_.failure();
    sqlite3_reset(statement_.get());
    next_ = 1;
    return error;
  }
  sqlite3_reset(statement_.get());
  next_ = 1;
  return false;
}

Result<void> SqliteStatement::run() {
  const auto done = step();
  ARTUS_TRY(done);
  return {};
}

std::string SqliteStatement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text == nullptr ? "" : text;
}

std::int64_t SqliteStatement::whole(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double SqliteStatement::number(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

bool SqliteStatement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

Result<SqliteTransaction> SqliteTransaction::begin(SqliteFile& file) {
  ARTUS_TRY(file.run("BEGIN IMMEDIATE"));
  return SqliteTransaction(file);
}

SqliteTransaction::SqliteTransaction(SqliteTransaction&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)) {}

SqliteTransaction::~SqliteTransaction() {
  if (file_ != nullptr) static_cast<void>(file_->run("ROLLBACK"));
}

Result<void> SqliteTransaction::commit() {
  ARTUS_TRY(file_->run("COMMIT"));
  file_ = nullptr;
  return {};
}

}  // namespace artus
