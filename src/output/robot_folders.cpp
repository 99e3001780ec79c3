#include "fleetmap/output/robot_folders.hpp"

#include <algorithm>

#include "fleetmap/core/paths.hpp"

namespace fleetmap::output {

std::vector<std::filesystem::path> robot_folders(const std::filesystem::path& directory, const char* file) {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (is_there(entry.path() / file)) folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  return folders;
}

}  // namespace fleetmap::output
