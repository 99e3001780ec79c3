#pragma once

#include <filesystem>
#include <string_view>

namespace fleetmap {

/// A new folder in the system's temporary one, for this process alone, that goes with the object.
class WorkFolder {
 public:
  /// Throws std::filesystem::filesystem_error where none can be made.
  explicit WorkFolder(std::string_view name);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace fleetmap
