#include "faulty_file_system.hpp"

#include <sqlite3.h>

#include <atomic>

namespace fleetmap::fault_injection {
namespace {

/// SQLite allocates szOsFile bytes for each: this one, then the file of the system behind it.
struct File {
  sqlite3_file base;
  const std::atomic<int>* refusal;  ///< the result of a write
};

sqlite3_file* real(sqlite3_file* file) {
  return reinterpret_cast<sqlite3_file*>(reinterpret_cast<File*>(file) + 1);
}

int write(sqlite3_file* file, const void* data, int bytes, sqlite3_int64 offset) {
  if (const int refusal = *reinterpret_cast<const File*>(file)->refusal; refusal != SQLITE_OK) return refusal;
  sqlite3_file* behind = real(file);
  return behind->pMethods->xWrite(behind, data, bytes, offset);
}

int sync(sqlite3_file*, int) { return SQLITE_OK; }

/// Calls `Method` of the file behind.
template <auto Method>
struct Forward;
template <class... Arguments, int (*sqlite3_io_methods::*Method)(sqlite3_file*, Arguments...)>
struct Forward<Method> {
  static int call(sqlite3_file* file, Arguments... arguments) {
    sqlite3_file* behind = real(file);
    return (behind->pMethods->*Method)(behind, arguments...);
  }
};
void shm_barrier(sqlite3_file* file) { real(file)->pMethods->xShmBarrier(real(file)); }

#define FLEETMAP_FORWARD(name) Forward<&sqlite3_io_methods::name>::call
const sqlite3_io_methods kMethods = {
    2,  // with shared memory for the write-ahead log, without memory mapping
    FLEETMAP_FORWARD(xClose),
    FLEETMAP_FORWARD(xRead),
    write,
    FLEETMAP_FORWARD(xTruncate),
    sync,
    FLEETMAP_FORWARD(xFileSize),
    FLEETMAP_FORWARD(xLock),
    FLEETMAP_FORWARD(xUnlock),
    FLEETMAP_FORWARD(xCheckReservedLock),
    FLEETMAP_FORWARD(xFileControl),
    FLEETMAP_FORWARD(xSectorSize),
    FLEETMAP_FORWARD(xDeviceCharacteristics),
    FLEETMAP_FORWARD(xShmMap),
    FLEETMAP_FORWARD(xShmLock),
    shm_barrier,
    FLEETMAP_FORWARD(xShmUnmap),
    nullptr,
    nullptr,
};
#undef FLEETMAP_FORWARD

}  // namespace

struct FaultyFileSystem::State {
  std::string name;
  std::atomic<int> refusal = SQLITE_OK;
  sqlite3_vfs* system = nullptr;
  sqlite3_vfs vfs{};

  static int open(sqlite3_vfs* vfs, const char* path, sqlite3_file* file, int flags, int* flags_out) {
    const auto* state = static_cast<const State*>(vfs->pAppData);
    reinterpret_cast<File*>(file)->refusal = &state->refusal;
    file->pMethods = nullptr;
    const int code = state->system->xOpen(state->system, path, real(file), flags, flags_out);
    if (code == SQLITE_OK) file->pMethods = &kMethods;
    return code;
  }
};

FaultyFileSystem::FaultyFileSystem() : state_(std::make_unique<State>()) {
  static std::atomic<unsigned> count = 0;
  State& s = *state_;
  s.name = "faulty-" + std::to_string(count++);
  s.system = sqlite3_vfs_find(nullptr);
  // All but files is the system's own: its functions use nothing of the sqlite3_vfs that they are given.
  s.vfs = *s.system;
  s.vfs.szOsFile = static_cast<int>(sizeof(File)) + s.system->szOsFile;
  s.vfs.zName = s.name.c_str();
  s.vfs.pAppData = &s;
  s.vfs.xOpen = State::open;
  sqlite3_vfs_register(&s.vfs, 0);
}

FaultyFileSystem::~FaultyFileSystem() { sqlite3_vfs_unregister(&state_->vfs); }

const std::string& FaultyFileSystem::name() const { return state_->name; }
void FaultyFileSystem::set_full(bool full) { state_->refusal = full ? SQLITE_FULL : SQLITE_OK; }
bool FaultyFileSystem::is_full() const { return state_->refusal == SQLITE_FULL; }
void FaultyFileSystem::set_read_only(bool read_only) {
  // SQLite's result for EROFS on a file that it opened for writing.
  state_->refusal = read_only ? SQLITE_IOERR_WRITE : SQLITE_OK;
}

}  // namespace fleetmap::fault_injection
