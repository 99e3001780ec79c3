#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::recording {

/// One prepared SQLite statement.
class Statement {
 public:
  explicit Statement(sqlite3_stmt* statement) : statement_(statement, sqlite3_finalize) {}
  void bind(int index, std::int64_t value) { sqlite3_bind_int64(statement_.get(), index, value); }
  void bind(int index, const std::string& text) {
    sqlite3_bind_text(statement_.get(), index, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  }
  /// The bytes must live until the next step().
  void bind(int index, ByteView bytes) {
    // SQLite takes a null pointer for NULL, not for no bytes.
    const void* data = bytes.empty() ? static_cast<const void*>("") : bytes.data();
    sqlite3_bind_blob64(statement_.get(), index, data, bytes.size(), SQLITE_STATIC);
  }
  /// SQLITE_ROW, SQLITE_DONE or an error code.
  int step() { return sqlite3_step(statement_.get()); }
  void reset() { sqlite3_reset(statement_.get()); }
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  std::string text(int column) const;
  /// Valid until the next step() or reset().
  ByteView blob(int column) const;

 private:
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
};

/// One SQLite file. Errors name the file. Written by hand (90 lines) and apart from store::Database, which
/// holds the durability of a write-ahead log that a bag does not need; SQLiteCpp throws where a damaged bag
/// has to return an Error.
class Database {
 public:
  static Result<Database> open_for_reading(const std::filesystem::path& file);
  static Result<Database> create(const std::filesystem::path& file);

  Result<Statement> prepare(const char* sql) const;
  Status execute(const char* sql) const;
  /// SQLite's message about the last failure.
  Error error(const std::string& doing) const;
  std::int64_t last_insert_id() const { return sqlite3_last_insert_rowid(connection_.get()); }

 private:
  Database(sqlite3* connection, std::filesystem::path file)
      : connection_(connection, sqlite3_close_v2), file_(std::move(file)) {}
  static Result<Database> open(const std::filesystem::path& file, const std::string& uri, int flags);

  std::unique_ptr<sqlite3, int (*)(sqlite3*)> connection_;
  std::filesystem::path file_;
};

}  // namespace fleetmap::recording
