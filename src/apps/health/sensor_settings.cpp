#include "sensor_settings.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include "fleetmap/config/robot_file.hpp"
#include "options.hpp"

namespace fleetmap::apps {

CommandResult<config::RobotConfig> sensor_settings(const std::string& file,
                                                   const std::vector<std::string>& set) {
  const auto overrides = parse_overrides(set);
  if (!overrides) return exit_with(kUsage, overrides.error());
  auto settings = config::load_sensors(
      file.empty() ? std::nullopt : std::optional<std::filesystem::path>(file), *overrides);
  if (!settings) return exit_with(kBadConfiguration, settings.error());
  return std::move(*settings);
}

}  // namespace fleetmap::apps
