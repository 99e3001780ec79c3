#include "fleetmap/core/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace fleetmap {

namespace {

const char* remedy(int code) {
  switch (code) {
    case EROFS:
      return "; its disk is read-only: look why (dmesg), make it writable (mount -o remount,rw) or use "
             "another folder";
    case EACCES:
    case EPERM:
      return "; let the program's user write in the folder";
    case ENOENT:
      return "; make the folder";
    case ENOSPC:
    case EDQUOT:
      return "; free space";
    default:
      return "; check the folder and its disk";
  }
}

}  // namespace

Result<std::optional<FileLock>> FileLock::try_lock(const std::filesystem::path& file, Kind kind) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    const int code = errno;
    return failure(file.string() + ": cannot be written: " + std::strerror(code) + remedy(code));
  }
  FileLock lock(descriptor);
  const int operation = (kind == Kind::kShared ? LOCK_SH : LOCK_EX) | LOCK_NB;
  if (::flock(descriptor, operation) != 0 && errno == EWOULDBLOCK) return std::optional<FileLock>();
  return std::optional<FileLock>(std::move(lock));
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace fleetmap
