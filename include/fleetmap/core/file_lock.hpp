#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "fleetmap/core/result.hpp"

namespace fleetmap {

/// An advisory lock on a file (flock). The system releases it with the object or the process, however that
/// ends. Linux passes it on to the server of an NFS share, so it also holds between machines. On a file
/// system without locks nothing is locked, and nothing fails.
class FileLock {
 public:
  enum class Kind { kShared, kExclusive };

  /// Empty while another process holds the lock in a way that excludes `kind`; an error when `file` cannot be
  /// made. The file stays where it is: to remove it would let two processes lock two files of one name.
  static Result<std::optional<FileLock>> try_lock(const std::filesystem::path& file, Kind kind);

  FileLock() = default;
  FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileLock& operator=(FileLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~FileLock();

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace fleetmap
