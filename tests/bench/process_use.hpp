#pragma once

#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

namespace fleetmap::bench {

/// Memory of this process that is resident, MB.
inline double resident_mb() {
  std::size_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// Size of the files of a folder whose names end so, MB.
inline double files_mb(const std::filesystem::path& folder, const std::string& end) {
  double bytes = 0.0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().string().ends_with(end)) bytes += static_cast<double>(entry.file_size());
  }
  return bytes / 1e6;
}

}  // namespace fleetmap::bench
