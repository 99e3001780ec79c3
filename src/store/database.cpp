#include "database.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "big_endian.hpp"
#include "fleetmap/core/file_uri.hpp"
#include "log_scan.hpp"

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

constexpr int kPagesBeforeCheckpoint = 1000;  // as SQLite's own

/// The open file of a log; null when nothing was written.
sqlite3_file* log_file(sqlite3* db) {
  // SQLite has no call that syncs the log, but returns its file; the first sync includes the folder.
  sqlite3_file* file = nullptr;
  sqlite3_file_control(db, "main", SQLITE_FCNTL_JOURNAL_POINTER, static_cast<void*>(&file));
  return file && file->pMethods ? file : nullptr;
}

/// Makes pages from `begin` on dirty again that the system counts as clean.
bool write_again(sqlite3_file& file, std::size_t begin) {
  sqlite3_int64 size = 0;
  if (file.pMethods->xFileSize(&file, &size) != SQLITE_OK) return false;
  Bytes piece;
  for (auto at = static_cast<sqlite3_int64>(begin); at < size;
       at += static_cast<sqlite3_int64>(piece.size())) {
    piece.resize(static_cast<std::size_t>(std::min<sqlite3_int64>(size - at, 1 << 16)));
    const int bytes = static_cast<int>(piece.size());
    if (file.pMethods->xRead(&file, piece.data(), bytes, at) != SQLITE_OK) return false;
    if (file.pMethods->xWrite(&file, piece.data(), bytes, at) != SQLITE_OK) return false;
  }
  return true;
}

/// Moves the whole log into the file, whose sync is that of pages which this process wrote, and empties it:
/// what a power cut left of it would be moved again.
bool move_log(sqlite3* db, sqlite3_file& file) {
  return sqlite3_wal_checkpoint_v2(db, "main", SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr) == SQLITE_OK &&
         file.pMethods->xSync(&file, SQLITE_SYNC_NORMAL) == SQLITE_OK;
}

enum class LogSync { kDone, kFailed, kLost };

LogSync sync(LogState& log) {
  sqlite3_file* file = log_file(log.db);
  if (!file) return LogSync::kDone;
  if (log.left) {
    if (!move_log(log.db, *file)) return LogSync::kFailed;
    log.left = false;
    log.frames = log.durable = 0;
    log.set_uncertain(false);
    return LogSync::kDone;
  }
  if (log.uncertain) {
    const LogContent found = scan_log(sqlite3_filename_wal(sqlite3_db_filename(log.db, "main")));
    const bool anew = found.generation > log.generation;  // and nothing was committed since
    if (log.frames > 0 && !anew && (found.generation < log.generation || found.frames < log.frames))
      return LogSync::kLost;
    // Sound pages on the disk are left alone, because a power cut may tear a page that is being written.
    const std::size_t begin = anew || log.durable == 0 ? 0 : end_of_frames(log.durable, found.page_bytes);
    if (!write_again(*file, begin)) return LogSync::kFailed;
  }
  const bool synced = file->pMethods->xSync(file, SQLITE_SYNC_NORMAL) == SQLITE_OK;
  log.set_uncertain(!synced);
  if (synced) log.durable = log.frames;
  return synced ? LogSync::kDone : LogSync::kFailed;
}

/// After each commit. In the place of SQLite's own checkpoints, which hide that a sync has failed, and move a
/// log into its file of which a power cut would leave half.
int after_commit(void* state, sqlite3* db, const char* name, int frames) {
  auto& log = *static_cast<LogState*>(state);
  log.note_commit(static_cast<std::size_t>(frames));
  if (frames < kPagesBeforeCheckpoint || (log.uncertain && sync(log) != LogSync::kDone)) return SQLITE_OK;
  // Syncs the log first.
  if (sqlite3_wal_checkpoint_v2(db, name, SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr) == SQLITE_OK) {
    log.durable = log.frames;
  } else {
    log.note_error();
  }
  return SQLITE_OK;  // the commit itself is done
}

/// SQLite cannot make the index of the log, which it needs beside the file even to read it.
bool cannot_write_beside(sqlite3* db) {
  const int code = sqlite3_exec(db, "SELECT count(*) FROM sqlite_master", nullptr, nullptr, nullptr) & 0xff;
  return code == SQLITE_CANTOPEN || code == SQLITE_READONLY;
}

/// A log or a journal beside the file has changes that the file lacks.
bool has_unmoved_changes(const std::filesystem::path& path) {
  return std::ranges::any_of(std::array{"-wal", "-journal"}, [&](const char* suffix) {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(path.string() + suffix, none);
    return !none && bytes > 0;
  });
}

}  // namespace

void LogState::note_commit(std::size_t all_frames) {
  std::array<std::uint8_t, 4> bytes{};
  sqlite3_file* file = log_file(db);
  if (file && file->pMethods->xRead(file, bytes.data(), bytes.size(), kGenerationInLog) == SQLITE_OK) {
    const auto number = static_cast<std::uint32_t>(big_endian(bytes));
    if (number != generation) durable = 0;
    generation = number;
  }
  frames = all_frames;
}

void LogState::note_error() {
  const int code = sqlite3_extended_errcode(db);
  if (code == SQLITE_IOERR_FSYNC || code == SQLITE_IOERR_DIR_FSYNC) set_uncertain(true);
}

void LogState::set_uncertain(bool now) {
  uncertain = now;
  sqlite3_db_config(db, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, now ? 1 : 0, nullptr);
}

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
  log_->note_error();
  const char* file = sqlite3_db_filename(log_->db, "main");
  return failure(std::string(file ? file : "store") + ": " + sqlite3_errmsg(log_->db) + advice(code));
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

Result<Database> Database::connect(const std::filesystem::path& path, const std::string& name, int flags,
                                   const std::string& file_system) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &handle, flags | SQLITE_OPEN_NOMUTEX,
                                   file_system.empty() ? nullptr : file_system.c_str());
  Database db;
  db.db_.reset(handle);
  if (code != SQLITE_OK) {
    return failure(path.string() + ": " + (handle ? sqlite3_errmsg(handle) : "out of memory") + advice(code));
  }
  sqlite3_busy_timeout(handle, kBusyTimeoutMs);
  sqlite3_extended_result_codes(handle, 1);
  db.log_->db = handle;
  return db;
}

Result<Database> Database::open(const std::filesystem::path& path, bool read_only,
                                const std::string& file_system) {
  const int flags = read_only ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  auto db = connect(path, path.string(), flags, file_system);
  if (!db) return db;
  if (!read_only) sqlite3_wal_hook(db->db_.get(), after_commit, db->log_.get());
  if (!read_only || !cannot_write_beside(db->db_.get())) return db;
  if (has_unmoved_changes(path)) {
    return failure(path.string() + ": cannot be read where it lies, because the log beside it (-wal) holds " +
                   "a part of it and nothing can be written there; copy both to a folder that can be " +
                   "written, and read the copy");
  }
  return connect(path, file_uri(path, "?immutable=1"), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, file_system);
}

Status Database::execute(const char* sql) {
  if (sqlite3_exec(db_.get(), sql, nullptr, nullptr, nullptr) == SQLITE_OK) return {};
  log_->note_error();
  return error(sql);
}

Result<Statement> Database::prepare(std::string_view sql) const {
  sqlite3_stmt* stmt = nullptr;
  if (sqlite3_prepare_v2(db_.get(), sql.data(), static_cast<int>(sql.size()), &stmt, nullptr) != SQLITE_OK) {
    return error(sql);
  }
  return Statement(*log_, stmt);
}

Result<std::int64_t> Database::integer(const char* sql) const {
  auto statement = prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  const auto row = statement->step();
  if (!row) return tl::unexpected(row.error());
  return *row ? statement->integer(0) : 0;
}

void Database::mark_left_log() {
  log_->left = true;
  log_->set_uncertain(true);
}

Status Database::sync_log() {
  switch (sync(*log_)) {
    case LogSync::kDone:
      return {};
    case LogSync::kFailed:
      return failure(file() + ": cannot be synced to the disk; " + kBadDisk);
    case LogSync::kLost:
      break;
  }
  return failure(file() + ": the disk has lost what was written: " + kBadDisk + " and start again");
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
