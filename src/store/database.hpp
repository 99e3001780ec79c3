#pragma once

#include <sqlite3.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::store {

/// Durability of a connection's write-ahead log.
struct LogState {
  sqlite3* db = nullptr;
  std::uint32_t generation = 0;  ///< at the last commit (LogContent)
  std::size_t frames = 0;        ///< that were committed; 0 until the first commit
  std::size_t durable = 0;       ///< of these, up to the last sync that succeeded
  /// A sync failed. The system then counts the pages as written and may drop them, so that a later successful
  /// sync proves nothing about them.
  bool uncertain = false;
  /// The log was left by a killed process, perhaps after such a sync, so the part of it that is on the disk
  /// is unknown.
  bool left = false;

  void note_commit(std::size_t all_frames);
  /// Notes whether the last error of the connection was a sync's.
  void note_error();
  void set_uncertain(bool now);
};

/// One prepared statement in use. Bind from 1, read columns from 0.
class Statement {
 public:
  Statement(LogState& log, sqlite3_stmt* stmt) : log_(&log), stmt_(stmt) {}
  Statement(Statement&& other) noexcept : log_(other.log_), stmt_(std::exchange(other.stmt_, nullptr)) {}
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
  LogState* log_;
  sqlite3_stmt* stmt_;
};

/// A SQLite connection whose errors name the file and the remedy. Written by hand: SQLiteCpp (3.2.1 in Debian
/// 12) would replace about 120 of the 276 lines of database.cpp, and throw where a Result is needed; the
/// log's durability (LogState) needs SQLite's C interface in any case.
class Database {
 public:
  /// To be read, a file may lie where nothing can be written: on a medium that is mounted read-only, or in
  /// another user's folder. It is then read without locks, as one that nobody changes, and opening fails if a
  /// log with content lies beside it. `file_system`: name of a SQLite VFS; empty: the system's own.
  static Result<Database> open(const std::filesystem::path& path, bool read_only,
                               const std::string& file_system = {});

  Status execute(const char* sql);
  Result<Statement> prepare(std::string_view sql) const;
  Result<std::int64_t> integer(const char* sql) const;
  /// Rows that were inserted, updated or deleted since the file was opened.
  std::int64_t changes() const { return sqlite3_total_changes64(db_.get()); }
  /// Makes all commits in the write-ahead log survive a power cut. After a failed sync, the frames since the
  /// last successful one are written again first. Fails also when these frames can no longer be read.
  Status sync_log();
  /// Part of the log may not be on the disk, though it can be read.
  bool log_is_uncertain() const { return log_->uncertain; }
  /// The log is of another process: sync_log() then moves all of it into the file.
  void mark_left_log();
  /// A commit with synchronous = FULL has synced the log.
  void note_log_synced() { log_->durable = log_->frames; }
  /// The last error shows that the file is damaged or that parts of it cannot be read.
  bool is_damaged() const;
  std::string last_error() const { return sqlite3_errmsg(db_.get()); }
  tl::unexpected<Error> error(std::string_view doing) const;

 private:
  static Result<Database> connect(const std::filesystem::path& path, const std::string& name, int flags,
                                  const std::string& file_system);
  std::string file() const;
  struct Close {
    void operator()(sqlite3* db) const { sqlite3_close_v2(db); }
  };
  std::unique_ptr<LogState> log_ = std::make_unique<LogState>();
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
