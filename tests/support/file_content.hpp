#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

/// All of a file; empty if there is none.
inline std::string file_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline Bytes file_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace fleetmap::testing
