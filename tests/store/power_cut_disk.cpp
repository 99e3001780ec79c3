#include "store/power_cut_disk.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <new>
#include <random>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "support/file_content.hpp"

namespace fleetmap::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSector = 512;

/// A write, or with `truncation` a new size.
struct Change {
  std::size_t offset = 0;
  Bytes data;
  bool truncation = false;
};

void make_change(const Change& change, Bytes& image) {
  if (change.truncation) return image.resize(change.offset);
  image.resize(std::max(image.size(), change.offset + change.data.size()));
  std::ranges::copy(change.data, image.begin() + static_cast<std::ptrdiff_t>(change.offset));
}

/// The content of a file after a power cut, and the writes since.
struct Content {
  Bytes durable;
  std::vector<Change> pending;

  void sync() {
    for (const Change& change : pending) make_change(change, durable);
    pending.clear();
  }
};

/// A name in the folder: which file it is after a power cut, if any, and which it is now.
struct Entry {
  std::shared_ptr<Content> durable;
  std::shared_ptr<Content> now;
};

enum class Survival { kNothing, kPrefix, kSectors };

void apply_survivors(Content& content, Survival survival, std::mt19937& random) {
  if (survival == Survival::kNothing || content.pending.empty()) return content.pending.clear();
  const auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
  if (survival == Survival::kPrefix) {
    content.pending.resize(random() % (content.pending.size() + 1));
    return content.sync();
  }
  for (const Change& change : content.pending) {
    if (change.truncation) {
      if (chance(0.5)) make_change(change, content.durable);
      continue;
    }
    for (std::size_t begin = 0; begin < change.data.size();) {
      const std::size_t end =
          std::min(change.data.size(), begin + kSector - (change.offset + begin) % kSector);
      Change sector{change.offset + begin,
                    Bytes(change.data.begin() + static_cast<std::ptrdiff_t>(begin),
                          change.data.begin() + static_cast<std::ptrdiff_t>(end)),
                    false};
      begin = end;
      if (!chance(0.5)) continue;
      if (chance(0.1))
        std::ranges::generate(sector.data, [&] { return static_cast<std::uint8_t>(random()); });
      make_change(sector, content.durable);
    }
  }
  content.pending.clear();
}

}  // namespace

struct PowerCutDisk::State {
  /// Lies behind the system's own file in the memory that SQLite gives to each; the system's methods are
  /// called with the same pointer, so that only those which differ need be written.
  struct Extra {
    State* state = nullptr;
    std::shared_ptr<Content> content;  ///< null: a file that nobody misses
    const sqlite3_io_methods* system = nullptr;
    sqlite3_io_methods methods{};
    bool new_in_folder = false;  ///< its first sync is one of the folder, too
  };

  std::string name;
  std::mt19937 random;
  std::size_t operations = 0;
  std::size_t syncs = 0;
  std::size_t failing_syncs = 0;
  std::size_t cut_at = SIZE_MAX;
  bool cut = false;
  std::map<std::string, Entry> entries;
  sqlite3_vfs* system = nullptr;
  sqlite3_vfs vfs{};
  static inline std::size_t extra_offset = 0;

  static Extra& extra(sqlite3_file* file) {
    return *std::launder(reinterpret_cast<Extra*>(reinterpret_cast<char*>(file) + extra_offset));
  }

  /// False when the power is gone or goes with this operation.
  bool operate() {
    cut = cut || ++operations >= cut_at;
    return !cut;
  }

  void sync_folder() {
    for (auto it = entries.begin(); it != entries.end();) {
      it->second.durable = it->second.now;
      it = it->second.now ? std::next(it) : entries.erase(it);
    }
  }

  static int write(sqlite3_file* file, const void* data, int bytes, sqlite3_int64 offset) {
    Extra& e = extra(file);
    if (e.state->cut) return SQLITE_IOERR_WRITE;
    const auto* begin = static_cast<const std::uint8_t*>(data);
    if (e.content)
      e.content->pending.push_back({static_cast<std::size_t>(offset), Bytes(begin, begin + bytes), false});
    if (e.content && !e.state->operate()) return SQLITE_IOERR_WRITE;
    return e.system->xWrite(file, data, bytes, offset);
  }

  static int truncate(sqlite3_file* file, sqlite3_int64 size) {
    Extra& e = extra(file);
    if (e.state->cut) return SQLITE_IOERR_TRUNCATE;
    if (e.content) e.content->pending.push_back({static_cast<std::size_t>(size), {}, true});
    if (e.content && !e.state->operate()) return SQLITE_IOERR_TRUNCATE;
    return e.system->xTruncate(file, size);
  }

  static int sync(sqlite3_file* file, int) {
    Extra& e = extra(file);
    if (e.state->cut || !e.state->operate()) return SQLITE_IOERR_FSYNC;
    ++e.state->syncs;
    if (e.state->failing_syncs > 0) {
      --e.state->failing_syncs;
      if (e.content)
        apply_survivors(*e.content, static_cast<Survival>(e.state->random() % 3), e.state->random);
      return SQLITE_IOERR_FSYNC;
    }
    if (e.content) e.content->sync();
    if (std::exchange(e.new_in_folder, false)) e.state->sync_folder();
    return SQLITE_OK;  // the system's disk keeps its power
  }

  static int close(sqlite3_file* file) {
    Extra& e = extra(file);
    const sqlite3_io_methods* system = e.system;
    e.~Extra();
    return system->xClose(file);
  }

  static int open(sqlite3_vfs* vfs, const char* path, sqlite3_file* file, int flags, int* flags_out) {
    auto* state = static_cast<State*>(vfs->pAppData);
    file->pMethods = nullptr;
    if (state->cut) return SQLITE_CANTOPEN;
    const bool kept = (flags & (SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_WAL)) != 0;
    const bool existed = path != nullptr && fs::exists(path);
    Bytes before = kept && existed && !state->entries.contains(path) ? testing::file_bytes(path) : Bytes{};
    const int code = state->system->xOpen(state->system, path, file, flags, flags_out);
    if (code != SQLITE_OK) return code;
    auto* e = new (reinterpret_cast<char*>(file) + extra_offset) Extra;
    e->state = state;
    e->system = file->pMethods;
    e->methods = *file->pMethods;
    e->methods.iVersion = std::min(e->methods.iVersion, 2);  // no memory mapping
    e->methods.xWrite = write;
    e->methods.xTruncate = truncate;
    e->methods.xSync = sync;
    e->methods.xClose = close;
    file->pMethods = &e->methods;
    if (!kept) return SQLITE_OK;
    Entry& entry = state->entries[path];
    if (!entry.now) {
      entry.now = std::make_shared<Content>(Content{std::move(before), {}});
      if (existed) entry.durable = entry.now;
      e->new_in_folder = !existed && (flags & SQLITE_OPEN_MAIN_DB) == 0;
    }
    e->content = entry.now;
    return SQLITE_OK;
  }

  static int remove(sqlite3_vfs* vfs, const char* path, int sync_folder) {
    auto* state = static_cast<State*>(vfs->pAppData);
    if (state->cut || !state->operate()) return SQLITE_IOERR_DELETE;
    if (const auto entry = state->entries.find(path); entry != state->entries.end())
      entry->second.now.reset();
    if (sync_folder != 0) state->sync_folder();
    return state->system->xDelete(state->system, path, 0);
  }
};

PowerCutDisk::PowerCutDisk(std::uint32_t seed) : state_(std::make_unique<State>()) {
  static std::atomic<unsigned> count = 0;
  State& s = *state_;
  s.name = "power-cut-" + std::to_string(count++);
  s.random.seed(seed);
  s.system = sqlite3_vfs_find(nullptr);
  s.vfs = *s.system;
  constexpr std::size_t kAlign = alignof(State::Extra);
  State::extra_offset = (static_cast<std::size_t>(s.system->szOsFile) + kAlign - 1) / kAlign * kAlign;
  s.vfs.szOsFile = static_cast<int>(State::extra_offset + sizeof(State::Extra));
  s.vfs.zName = s.name.c_str();
  s.vfs.pAppData = &s;
  s.vfs.xOpen = State::open;
  s.vfs.xDelete = State::remove;
  sqlite3_vfs_register(&s.vfs, 0);
}

PowerCutDisk::~PowerCutDisk() { sqlite3_vfs_unregister(&state_->vfs); }

const std::string& PowerCutDisk::name() const { return state_->name; }
void PowerCutDisk::cut_after(std::size_t operations) {
  state_->cut_at = state_->operations + std::max<std::size_t>(operations, 1);
}
void PowerCutDisk::fail_syncs(std::size_t count) { state_->failing_syncs = count; }
void PowerCutDisk::kill() { state_->cut = true; }
void PowerCutDisk::revive() { state_->cut = false; }
bool PowerCutDisk::is_cut() const { return state_->cut; }
std::size_t PowerCutDisk::operations() const { return state_->operations; }
std::size_t PowerCutDisk::syncs() const { return state_->syncs; }

void PowerCutDisk::restore_power() {
  State& s = *state_;
  const auto survival = static_cast<Survival>(s.random() % 3);
  for (auto& [path, entry] : s.entries) {
    const bool folder_changed = survival != Survival::kNothing && s.random() % 2 == 0;
    const std::shared_ptr<Content> content = folder_changed ? entry.now : entry.durable;
    fs::remove(path);
    fs::remove(path + "-shm");
    if (!content) continue;
    apply_survivors(*content, survival, s.random);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(content->durable.data()),
               static_cast<std::streamsize>(content->durable.size()));
  }
  s.entries.clear();
  s.cut = false;
  s.failing_syncs = 0;
  s.cut_at = SIZE_MAX;
}

}  // namespace fleetmap::testing
