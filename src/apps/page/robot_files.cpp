#include "robot_files.hpp"

#include <chrono>
#include <fstream>

namespace fleetmap::apps {

nlohmann::json report_of(const RobotFiles& files) {
  constexpr auto kClosedAfterwards = std::chrono::minutes(10);
  const std::filesystem::path file = files.folder / "report.json";
  std::error_code none, missing;
  const auto written = std::filesystem::last_write_time(file, none);
  if (none || std::filesystem::last_write_time(files.store, missing) - written > kClosedAfterwards) return {};
  std::ifstream in(file);
  auto report = nlohmann::json::parse(in, nullptr, false);
  return report.is_discarded() ? nlohmann::json() : report;
}

}  // namespace fleetmap::apps
