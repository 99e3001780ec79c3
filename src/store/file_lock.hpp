#pragma once

#include <filesystem>
#include <utility>

#include "fleetmap/core/result.hpp"

namespace fleetmap::store {

/// Held while a process writes a store; the system lets go of it when the process dies, however it dies.
class FileLock {
 public:
  /// Locks `path` + ".lock"; fails when another process holds it.
  static Result<FileLock> acquire(const std::filesystem::path& path);
  FileLock() = default;
  FileLock(FileLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileLock& operator=(FileLock&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileLock();

 private:
  explicit FileLock(int fd) : fd_(fd) {}
  int fd_ = -1;
};

}  // namespace fleetmap::store
