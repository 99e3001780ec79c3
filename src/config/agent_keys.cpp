#include "agent_keys.hpp"

#include "agent_sections.hpp"
#include "fleetmap/config/fleet_config.hpp"
#include "recording_section.hpp"
#include "ros_section.hpp"
#include "twin_sections.hpp"

namespace fleetmap::config {

std::set<std::string> agent_keys() {
  const YAML::Node nothing(YAML::NodeType::Map);
  Document document = Document::from(nothing, "");
  Section section(document, nothing, "");
  FleetConfig::Member member;
  read_agent(section, member.agent);
  read_recording(section);
  read_ros(section);
  read_robot_twin(section, member.robot, member.switched_off);
  return section.known_keys();
}

YAML::Node agent_keys_of(const YAML::Node& root, const std::set<std::string>& known) {
  YAML::Node keys(YAML::NodeType::Map);
  for (const auto& entry : root) {
    if (known.contains(entry.first.Scalar())) keys[entry.first] = entry.second;
  }
  return keys;
}

}  // namespace fleetmap::config
