#pragma once

#include <sqlite3.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::store {

/// One prepared statement in use. Bind from 1, read columns from 0.
class Statement {
 public:
  Statement(sqlite3* db, sqlite3_stmt* stmt) : db_(db), stmt_(stmt) {}
  Statement(Statement&& other) noexcept : db_(other.db_), stmt_(std::exchange(other.stmt_, nullptr)) {}
  Statement& operator=(Statement&&) = delete;
  ~Statement() { sqlite3_finalize(stmt_); }

  Statement& bind(int index, std::int64_t value);
  Statement& bind(int index, std::string_view text);  ///< kept by the caller until the statement goes
  Statement& bind(int index, ByteView blob);          ///< kept by the caller until the statement goes
  /// True while there is a row.
  Result<bool> step();
  Status run();
  std::int64_t integer(int column) const { return sqlite3_column_int64(stmt_, column); }
  std::string_view text(int column) const;
  ByteView blob(int column) const;

 private:
  sqlite3* db_;
  sqlite3_stmt* stmt_;
};

/// A SQLite connection whose errors say which file and what to do.
class Database {
 public:
  /// `file_system`: name of a SQLite VFS; empty: the system's own.
  static Result<Database> open(const std::filesystem::path& path, bool read_only,
                               const std::string& file_system = {});

  Status execute(const char* sql);
  Result<Statement> prepare(std::string_view sql) const;
  Result<std::int64_t> integer(const char* sql) const;
  /// Rows that were inserted, updated or deleted since the file was opened.
  std::int64_t changes() const { return sqlite3_total_changes64(db_.get()); }
  /// What was committed to the write-ahead log survives a power cut from now on.
  Status sync_log();
  /// The last error shows that the file is damaged or that parts of it cannot be read.
  bool is_damaged() const;
  std::string last_error() const { return sqlite3_errmsg(db_.get()); }
  tl::unexpected<Error> error(std::string_view doing) const;

 private:
  std::string file() const;
  struct Close {
    void operator()(sqlite3* db) const { sqlite3_close_v2(db); }
  };
  std::unique_ptr<sqlite3, Close> db_;
};

/// Rolls back unless committed.
class Transaction {
 public:
  static Result<Transaction> begin(Database& db);
  Transaction(Transaction&& other) noexcept : db_(std::exchange(other.db_, nullptr)) {}
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction();
  Status commit();

 private:
  explicit Transaction(Database& db) : db_(&db) {}
  Database* db_;
};

}  // namespace fleetmap::store
