#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>

#include "fleetmap/core/result.hpp"

namespace fleetmap::bus {

/// Folder of Fast DDS's segments.
inline constexpr const char* kSharedMemory = "/dev/shm";

/// Removes segments whose process was killed before it could: Fast DDS never does, and each is as large as
/// the profile sets. A segment is alive while its process holds the lock on the empty file beside it, which
/// it makes a moment before: none that is younger than `being_made` is touched. Returns the number of removed
/// segments.
std::size_t remove_dead_segments(const std::filesystem::path& folder = kSharedMemory,
                                 std::chrono::seconds being_made = std::chrono::seconds(5));

/// Fails, with the remedy, if the folder has no room for the segments of two processes of `segment_bytes`
/// each: a process that touches a page which is not there is ended by a bus error.
Status check_room(std::size_t segment_bytes, const std::filesystem::path& folder = kSharedMemory);

}  // namespace fleetmap::bus
