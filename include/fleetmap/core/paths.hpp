#pragma once

#include <filesystem>
#include <system_error>

namespace fleetmap {

/// std::filesystem's functions of these names throw for a path that is too long, leads through a file, or may
/// not be looked at. Here such a path is not there.
inline bool is_there(const std::filesystem::path& path) {
  std::error_code not_there;
  return std::filesystem::exists(path, not_there);
}

inline bool is_folder(const std::filesystem::path& path) {
  std::error_code not_there;
  return std::filesystem::is_directory(path, not_there);
}

/// As it is where the working directory is gone.
inline std::filesystem::path absolute_path(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::path absolute = std::filesystem::absolute(path, error);
  return error ? path : absolute;
}

}  // namespace fleetmap
