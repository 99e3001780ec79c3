#include "left_log.hpp"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <memory>

#include "database.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/paths.hpp"

namespace fleetmap::store {
namespace {

namespace fs = std::filesystem;

Bytes content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The log of a copy that is whole: its hash lies behind it. Else nothing.
Bytes log_in(Bytes copy) {
  if (copy.size() <= sizeof(ContentHash)) return {};
  const std::size_t size = copy.size() - sizeof(ContentHash);
  const ContentHash hash = content_hash(ByteView(copy).first(size));
  if (!std::ranges::equal(hash, ByteView(copy).subspan(size))) return {};
  copy.resize(size);
  return copy;
}

/// The file system under the store, which a test replaces, sees it as a log: its first sync is one of the
/// folder, too.
bool write_synced(sqlite3_vfs& system, const fs::path& file, ByteView bytes) {
  const std::string name = absolute_path(file).string();
  const auto memory = std::make_unique<std::max_align_t[]>(
      static_cast<std::size_t>(system.szOsFile) / sizeof(std::max_align_t) + 1);
  auto* out = reinterpret_cast<sqlite3_file*>(memory.get());
  const int flags = SQLITE_OPEN_WAL | SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  int opened = 0;
  if (system.xOpen(&system, name.c_str(), out, flags, &opened) != SQLITE_OK) return false;
  const auto& methods = *out->pMethods;
  constexpr std::size_t kPiece = 1u << 16;  // SQLite's own file system takes no more than twice as much
  bool written = true;
  for (std::size_t at = 0; written && at < bytes.size(); at += kPiece) {
    const ByteView piece = bytes.subspan(at, std::min(kPiece, bytes.size() - at));
    written = methods.xWrite(out, piece.data(), static_cast<int>(piece.size()),
                             static_cast<sqlite3_int64>(at)) == SQLITE_OK;
  }
  written = written && methods.xTruncate(out, static_cast<sqlite3_int64>(bytes.size())) == SQLITE_OK &&
            methods.xSync(out, SQLITE_SYNC_NORMAL) == SQLITE_OK;
  methods.xClose(out);
  return written;
}

bool remove_synced(sqlite3_vfs& system, const fs::path& file) {
  return !is_there(file) || system.xDelete(&system, absolute_path(file).c_str(), 1) == SQLITE_OK;
}

/// With its hash behind it.
Bytes copied(Bytes log) {
  const ContentHash hash = content_hash(log);
  log.insert(log.end(), hash.begin(), hash.end());
  return log;
}

}  // namespace

Status write_left_log_again(const fs::path& store, const std::string& file_system) {
  sqlite3_vfs* system = sqlite3_vfs_find(file_system.empty() ? nullptr : file_system.c_str());
  if (!system) return failure("there is no file system '" + file_system + "'");
  const fs::path log_file = store.string() + "-wal", copy = store.string() + "-left";
  Bytes log = log_in(content_of(copy));
  const bool cut_off = !log.empty();
  if (!cut_off) log = content_of(log_file);
  const bool is_copied = cut_off || (!log.empty() && write_synced(*system, copy, copied(log)));
  const bool whole = is_copied && write_synced(*system, log_file, log);
  if (cut_off && !whole)
    return failure(copy.string() + ": cannot be put back as " + log_file.string() +
                   "; check the disk, its free space and permissions");
  // It must not replace what is written to the log from now on.
  if (!remove_synced(*system, copy))
    return failure(copy.string() + ": cannot be removed; check the disk and the permissions");
  return {};
}

}  // namespace fleetmap::store
