#include "shared_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "fleetmap/core/receive_buffer.hpp"

namespace fleetmap::bus {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "fastrtps_";
constexpr std::string_view kPort = "fastrtps_port";
constexpr std::string_view kLock = "_el";

bool is_lock_of_segment(const std::string& name) {
  return name.starts_with(kPrefix) && !name.starts_with(kPort) && name.ends_with(kLock);
}

/// True if the segment's process is gone. Others' segments cannot be opened and count as alive.
bool is_dead(const fs::path& lock, std::chrono::seconds being_made) {
  const int file = open(lock.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  struct stat made {};
  const bool old =
      fstat(file, &made) == 0 &&
      std::chrono::system_clock::from_time_t(made.st_ctime) + being_made < std::chrono::system_clock::now();
  const bool dead = old && flock(file, LOCK_EX | LOCK_NB) == 0;
  close(file);
  return dead;
}

}  // namespace

std::size_t remove_dead_segments(const fs::path& folder, std::chrono::seconds being_made) {
  std::size_t removed = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!is_lock_of_segment(name) || !is_dead(entry->path(), being_made)) continue;
    std::error_code ignored;
    fs::remove(folder / name.substr(0, name.size() - kLock.size()), ignored);
    removed += fs::remove(entry->path(), ignored);
  }
  return removed;
}

Status check_room(std::size_t segment_bytes, const fs::path& folder) {
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  const std::size_t needed = 2 * segment_bytes + (1u << 20);
  if (!error && space.available >= needed) return {};
  const auto megabytes = [](std::uintmax_t bytes) { return std::to_string(bytes >> 20) + " MB"; };
  return failure(folder.string() + " has " + megabytes(error ? 0 : space.available) + " free and " +
                 megabytes(needed) + " are needed; give the container more (--shm-size=256m), or set " +
                 "dds.onboard.shared_memory to false and " + kRaiseReceiveBuffer);
}

}  // namespace fleetmap::bus
