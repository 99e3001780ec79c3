#include "fleetmap/core/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace fleetmap {

Result<std::optional<FileLock>> FileLock::try_lock(const std::filesystem::path& file, Kind kind) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0)
    return failure(file.string() + ": " + std::strerror(errno) + "; check the folder and its permissions");
  FileLock lock(descriptor);
  const int operation = (kind == Kind::kShared ? LOCK_SH : LOCK_EX) | LOCK_NB;
  if (::flock(descriptor, operation) != 0 && errno == EWOULDBLOCK) return std::optional<FileLock>();
  return std::optional<FileLock>(std::move(lock));
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace fleetmap
