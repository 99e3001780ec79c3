#include "database.hpp"

#include "fleetmap/core/file_uri.hpp"

namespace fleetmap::recording {
std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text == nullptr ? std::string() : std::string(text);
}

ByteView Statement::blob(int column) const {
  const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

Result<Database> Database::open(const std::filesystem::path& file, const std::string& uri, int flags) {
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &connection, flags | SQLITE_OPEN_URI, nullptr);
  Database database(connection, file);
  if (code != SQLITE_OK) return tl::unexpected(database.error("open"));
  return database;
}

Result<Database> Database::open_for_reading(const std::filesystem::path& file) {
  for (const char* query : {"", "?immutable=1"}) {
    auto database = open(file, file_uri(file, query), SQLITE_OPEN_READONLY);
    if (!database) return database;
    auto probe = database->prepare("SELECT count(*) FROM sqlite_master");
    const bool readable = probe && probe->step() == SQLITE_ROW;
    // A bag whose writer was killed still has its write-ahead log, which needs a writable folder; without
    // one, what is in the database file alone can be read.
    const bool needs_log = !readable && sqlite3_errcode(database->connection_.get()) == SQLITE_CANTOPEN;
    if (!needs_log) {
      if (readable) return database;
      return tl::unexpected(database->error("read"));
    }
  }
  return failure(file.string() + ": cannot be opened; copy the bag to a writable folder");
}

Result<Database> Database::create(const std::filesystem::path& file) {
  return open(file, file_uri(file, ""), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
}

Result<Statement> Database::prepare(const char* sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(connection_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
    return tl::unexpected(error("query"));
  }
  return Statement(statement);
}

Status Database::execute(const char* sql) const {
  if (sqlite3_exec(connection_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
    return tl::unexpected(error("write"));
  }
  return {};
}

Error Database::error(const std::string& doing) const {
  const int code = sqlite3_errcode(connection_.get());
  std::string message = file_.string() + ": cannot " + doing + ": " + sqlite3_errmsg(connection_.get());
  if (code == SQLITE_CORRUPT) {
    message += "; the file is damaged or truncated, `sqlite3 " + file_.filename().string() +
               " .recover | sqlite3 rescued.db3` saves what can be read";
  }
  if (code == SQLITE_NOTADB) message += "; this is no rosbag2 sqlite3 file";
  return Error{message};
}

}  // namespace fleetmap::recording
