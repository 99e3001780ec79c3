#include "database.hpp"

#include <utility>

namespace fleetmap::store {
namespace {

constexpr int kBusyTimeoutMs = 2000;  // a reader's checkpoint may hold the file for a moment

constexpr const char* kBadDisk =
    "the disk fails (see dmesg): others are not told what came since, replace the disk";

std::string advice(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return "; free space and start again";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "; the file is damaged or is no database: the robot's program keeps what is whole when it "
             "starts, "
             "and the rest comes back from other robots";
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return "; check the folder, its permissions and whether its disk is mounted read-only";
    case SQLITE_IOERR:
      return "; the disk fails, became read-only or was removed: look why (dmesg), mend it, then start again";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "; another process holds the file";
    default:
      return "";
  }
}

}  // namespace

Statement& Statement::bind(int index, std::int64_t value) {
  sqlite3_bind_int64(stmt_, index, value);
  return *this;
}

Statement& Statement::bind(int index, std::string_view text) {
  sqlite3_bind_text(stmt_, index, text.data(), static_cast<int>(text.size()), SQLITE_STATIC);
  return *this;
}

Statement& Statement::bind(int index, ByteView blob) {
  // A null pointer would bind NULL, and an empty blob is a value.
  sqlite3_bind_blob(stmt_, index, blob.empty() ? "" : static_cast<const void*>(blob.data()),
                    static_cast<int>(blob.size()), SQLITE_STATIC);
  return *this;
}

Result<bool> Statement::step() {
  const int code = sqlite3_step(stmt_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  const char* file = sqlite3_db_filename(db_, "main");
  return failure(std::string(file ? file : "store") + ": " + sqlite3_errmsg(db_) + advice(code));
}

Status Statement::run() {
  const auto row = step();
  if (!row) return tl::unexpected(row.error());
  return {};
}

std::string_view Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(stmt_, column));
  return text ? std::string_view(text, static_cast<std::size_t>(sqlite3_column_bytes(stmt_, column)))
              : std::string_view();
}

ByteView Statement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(stmt_, column));
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(stmt_, column))};
}

Result<Database> Database::open(const std::filesystem::path& path, bool read_only,
                                const std::string& file_system) {
  sqlite3* handle = nullptr;
  const int flags = read_only ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int code = sqlite3_open_v2(path.c_str(), &handle, flags | SQLITE_OPEN_NOMUTEX,
                                   file_system.empty() ? nullptr : file_system.c_str());
  Database db;
  db.db_.reset(handle);
  if (code != SQLITE_OK) {
    return failure(path.string() + ": " + (handle ? sqlite3_errmsg(handle) : "out of memory") + advice(code));
  }
  sqlite3_busy_timeout(handle, kBusyTimeoutMs);
  sqlite3_extended_result_codes(handle, 1);
  return db;
}

Status Database::execute(const char* sql) {
  if (sqlite3_exec(db_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) return error(sql);
  return {};
}

Result<Statement> Database::prepare(std::string_view sql) const {
  sqlite3_stmt* stmt = nullptr;
  if (sqlite3_prepare_v2(db_.get(), sql.data(), static_cast<int>(sql.size()), &stmt, nullptr) != SQLITE_OK) {
    return error(sql);
  }
  return Statement(db_.get(), stmt);
}

Result<std::int64_t> Database::integer(const char* sql) const {
  auto statement = prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  const auto row = statement->step();
  if (!row) return tl::unexpected(row.error());
  return *row ? statement->integer(0) : 0;
}

Status Database::sync_log() {
  // SQLite has no call for this, but gives out the log's file, whose first sync is one of the folder, too.
  sqlite3_file* log = nullptr;
  sqlite3_file_control(db_.get(), "main", SQLITE_FCNTL_JOURNAL_POINTER, static_cast<void*>(&log));
  if (!log || !log->pMethods) return {};  // nothing was written
  if (log->pMethods->xSync(log, SQLITE_SYNC_NORMAL) == SQLITE_OK) return {};
  return failure(file() + ": cannot be synced to the disk; " + kBadDisk);
}

bool Database::is_damaged() const {
  const int code = sqlite3_extended_errcode(db_.get());
  switch (code & 0xff) {
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return true;
    case SQLITE_IOERR:
      return code == SQLITE_IOERR_READ || code == SQLITE_IOERR_SHORT_READ || code == SQLITE_IOERR_CORRUPTFS;
    default:
      return false;
  }
}

std::string Database::file() const {
  const char* name = sqlite3_db_filename(db_.get(), "main");
  return name ? name : "store";
}

tl::unexpected<Error> Database::error(std::string_view doing) const {
  return failure(file() + ": " + sqlite3_errmsg(db_.get()) + " (" + std::string(doing.substr(0, 60)) + ")" +
                 advice(sqlite3_errcode(db_.get())));
}

Result<Transaction> Transaction::begin(Database& db) {
  if (const auto status = db.execute("BEGIN IMMEDIATE"); !status) return tl::unexpected(status.error());
  return Transaction(db);
}

Transaction::~Transaction() {
  if (db_) static_cast<void>(db_->execute("ROLLBACK"));
}

Status Transaction::commit() {
  const auto status = db_->execute("COMMIT");
  if (status) db_ = nullptr;
  return status;
}

}  // namespace fleetmap::store
