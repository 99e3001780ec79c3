#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace fleetmap::testing {

/// Writes `folder`/`name`.pgm as GeographicLib reads it: a geoid that is 0.1 m higher for each degree of
/// latitude, zero at the equator.
inline void write_sloped_geoid(const std::filesystem::path& folder, const std::string& name) {
  constexpr int kWidth = 8;
  std::ofstream out(folder / (name + ".pgm"), std::ios::binary);
  out << "P5\n# Offset -100\n# Scale 0.01\n# Origin 90N 0E\n" << kWidth << " 9\n65535\n";
  for (int row = 0; row < 9; ++row) {
    const int value = 10'000 + 900 - 225 * row;  // 22.5 degrees each
    for (int k = 0; k < kWidth; ++k)
      out.put(static_cast<char>(value >> 8)).put(static_cast<char>(value & 255));
  }
}

}  // namespace fleetmap::testing
