#include "fleetmap/config/mission_settings.hpp"

#include "mission_section.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

Result<planning::MissionConfig> load_mission_settings(const std::vector<Override>& overrides) {
  Document document = Document::from(YAML::Node(YAML::NodeType::Map), "command line");
  if (const Status applied = document.apply(overrides); !applied) return tl::unexpected(applied.error());
  Section top(document, document.root(), "");
  planning::MissionConfig mission;
  read_mission_settings(top, mission);
  top.finish();
  if (const Status status = document.status(); !status) return tl::unexpected(status.error());
  return mission;
}

}  // namespace fleetmap::config
