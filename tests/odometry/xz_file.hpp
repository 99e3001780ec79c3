#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace fleetmap::testing {

/// Reads the content of an .xz file, at most 64 MB; empty if it cannot be read.
std::vector<std::uint8_t> read_xz(const std::filesystem::path& file);

}  // namespace fleetmap::testing
