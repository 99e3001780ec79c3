#include "fleetmap/core/work_folder.hpp"

#include <stdlib.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace fleetmap {

WorkFolder::WorkFolder(std::string_view name) {
  std::string made = (std::filesystem::temp_directory_path() / name).string() + "_XXXXXX";
  if (mkdtemp(made.data()) == nullptr)
    throw std::filesystem::filesystem_error(made, std::error_code(errno, std::generic_category()));
  path_ = made;
}

WorkFolder::~WorkFolder() {
  std::error_code none;
  std::filesystem::remove_all(path_, none);
}

}  // namespace fleetmap
