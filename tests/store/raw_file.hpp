#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

inline constexpr std::size_t kPageBytes = 4096;  ///< bytes; SQLite's default

inline void write_file(const std::filesystem::path& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// Replaces the bytes of an existing file that begin at the offset.
inline void overwrite(const std::filesystem::path& file, std::size_t offset, const Bytes& bytes) {
  std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
  out.seekp(static_cast<std::streamoff>(offset));
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace fleetmap::testing
