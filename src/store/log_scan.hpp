#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>

namespace fleetmap::store {

inline constexpr std::size_t kLogHeaderBytes = 32;
inline constexpr std::size_t kGenerationInLog = 12;  ///< offset, B, of 4 bytes, the first one the highest

/// The content of a SQLite write-ahead log.
struct LogContent {
  std::size_t page_bytes = 0;
  std::uint32_t generation = 0;                 ///< counts how often the log began anew
  std::size_t frames = 0;                       ///< up to the end of the last whole transaction
  std::map<std::uint64_t, std::size_t> offset;  ///< in the log, of the last frame's data of each page
};

/// Reads a log as SQLite does when it recovers a database: frames count up to the first one whose salt or
/// cumulative checksum is wrong, and of these the ones of whole transactions. Empty for a file that is not
/// there or is no log. Format: https://www.sqlite.org/fileformat2.html#the_write_ahead_log.
LogContent scan_log(const std::filesystem::path& log);

/// The offset (B) at which the frame after `frames` others begins.
std::size_t end_of_frames(std::size_t frames, std::size_t page_bytes);

}  // namespace fleetmap::store
