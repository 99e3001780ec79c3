#include "local_files.hpp"

#include <unistd.h>

#include <system_error>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/geometry/geoid.hpp"

namespace fleetmap::apps {
namespace {

/// The folder, or the closest one above it that is there.
std::filesystem::path existing_part(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path part = std::filesystem::absolute(folder, error).lexically_normal();
  while (!is_there(part) && part.has_relative_path()) part = part.parent_path();
  return part;
}

}  // namespace

Status check_local_files(const agent::AgentConfig& config) {
  if (const auto part = existing_part(config.directory); !is_folder(part)) {
    return failure("directory: " + config.directory.string() + " cannot be made: " + part.string() +
                   " is no folder; give another one");
  }
  const auto& geoid = config.perception.devices.geoid;
  if (!geoid) return {};
  const auto loaded = Geoid::load(*geoid);
  if (!loaded) return failure("gps.geoid: " + loaded.error().message);
  return {};
}

std::optional<std::string> write_warning(const std::filesystem::path& folder) {
  const auto part = existing_part(folder);
  if (::access(part.c_str(), W_OK | X_OK) == 0) return std::nullopt;
  return "directory: " + part.string() +
         " cannot be written to by this user; the user that runs the agent needs it (chown), or give another "
         "folder";
}

}  // namespace fleetmap::apps
