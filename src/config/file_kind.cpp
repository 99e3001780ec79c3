#include "fleetmap/config/file_kind.hpp"

#include "document_kind.hpp"
#include "fleet_document.hpp"
#include "fleetmap/config/experiment_file.hpp"
#include "fleetmap/config/sensor_file.hpp"
#include "fleetmap/config/world_file.hpp"
#include "robot_document.hpp"

namespace fleetmap::config {

Result<FileKind> check(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = load_with(file, overrides);
  if (!document) return tl::unexpected(document.error());
  const FileKind kind = kind_of(document->root()).value_or(FileKind::kRobot);
  const bool may_override = kind == FileKind::kFleet || kind == FileKind::kRobot;
  if (!overrides.empty() && !may_override)
    return failure(file.string() + ": --set changes keys of AGENT.yaml and FLEET.yaml only");
  const auto checked = [&](const auto& loaded) -> Result<FileKind> {
    if (!loaded) return tl::unexpected(loaded.error());
    return kind;
  };
  if (kind == FileKind::kFleet) return checked(read_fleet(*document));
  if (kind == FileKind::kWorld) return checked(load_world(file));
  if (kind == FileKind::kSensor) return checked(load_lidar_spec(file));
  if (kind == FileKind::kExperiment) return checked(load_experiment(file, false));
  return checked(read_robot(*document));
}

}  // namespace fleetmap::config
