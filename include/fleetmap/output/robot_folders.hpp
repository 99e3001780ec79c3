#pragma once

#include <filesystem>
#include <vector>

namespace fleetmap::output {

/// The folders in `directory` that hold a file of this name, in the order of their names. None where
/// `directory` cannot be read.
std::vector<std::filesystem::path> robot_folders(const std::filesystem::path& directory, const char* file);

}  // namespace fleetmap::output
