#include "fleetmap/config/robot_file.hpp"

#include <algorithm>
#include <utility>

#include "agent_keys.hpp"
#include "agent_sections.hpp"
#include "dds_section.hpp"
#include "document_kind.hpp"
#include "fleetmap/config/fleet_agreement.hpp"
#include "keys_section.hpp"
#include "mission_section.hpp"
#include "recording_section.hpp"
#include "robot_document.hpp"
#include "ros_section.hpp"
#include "twin_sections.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

Result<RobotConfig> read_robot(Document& document) {
  RobotConfig robot;
  robot.dds.qos_directory = "qos";
  Section top(document, document.root(), "");
  read_agent(top, robot.agent);
  if (!top.has("id")) top.problem("id", "expected the robot's name, e.g. id: r1");
  robot.dds.agent = robot.agent.id;
  read_dds(top, robot.dds);
  read_keys(top, /*of_fleet=*/false, robot.agent, robot.dds);
  robot.agent.exchange.long_range.multicast = robot.dds.long_range.multicast;
  robot.dds.long_range.fleet_bits_per_second = 8.0 * robot.agent.exchange.long_range.fleet_bytes_per_second;
  Section dds = top.section("dds");
  if (dds.has("qos")) check_profiles(dds, robot.dds.qos_directory);
  robot.recording = read_recording(top);
  if (robot.recording) robot.recording->reader.ouster_metadata = robot.agent.perception.ouster.metadata;
  robot.ros = read_ros(top);
  robot.mission = read_mission(top, robot.agent);
  top.finish();
  if (robot.agent.directory.empty())
    top.problem("directory", "expected the folder where the agent keeps its store and maps");
  const std::vector<AgentId>& fleet = robot.agent.exchange.fleet;
  if (std::ranges::find(fleet, robot.agent.id) == fleet.end()) {
    top.problem("fleet", "expected the names of all robots, this one ('" + robot.agent.id.str() +
                             "') too, e.g. fleet: [r1, r2]");
  }
  if (const Status status = document.status(); !status) return tl::unexpected(status.error());
  if (const Status valid = robot.agent.validate(); !valid) {
    return failure(document.name() + ": " + valid.error().message);
  }
  robot.dds.settings = fleet_settings(robot.agent);
  return robot;
}

Result<RobotConfig> load_robot(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = load_with(file, overrides);
  if (!document) return tl::unexpected(document.error());
  const Status expected = expect_kind(*document, {FileKind::kRobot},
                                      "an agent, or of a fleet the name of one of its agents (--as r1)");
  if (!expected) return tl::unexpected(expected.error());
  return read_robot(*document);
}

Result<RobotConfig> load_sensors(const std::optional<std::filesystem::path>& file,
                                 const std::vector<Override>& overrides) {
  Result<Document> document = Document::from(YAML::Node(YAML::NodeType::Map), "command line");
  if (file) document = Document::load(*file);
  if (!document) return tl::unexpected(document.error());
  if (const Status applied = document->apply(overrides); !applied) return tl::unexpected(applied.error());
  const Status expected = expect_kind(*document, {FileKind::kRobot, FileKind::kFleet}, "an agent or a fleet");
  if (!expected) return tl::unexpected(expected.error());
  const YAML::Node& root = document->root();
  const bool is_fleet =
      root["agents"].IsDefined() && root["agents"].IsSequence() && root["agents"].size() > 0;
  const bool is_twin = root["world"].IsDefined();
  const YAML::Node entry =
      is_fleet ? merged(merged(root["defaults"], root["agents"][0]), agent_keys_of(root, agent_keys()))
               : root;
  Section top(*document, entry, "");
  FleetConfig::Member member;
  member.agent.id = AgentId::parse("r1").value();
  read_agent(top, member.agent);
  if (is_fleet) read_robot_twin(top, member.robot, member.switched_off);
  if (is_twin) suit_estimator(member, top.section("lidar"));
  RobotConfig robot;
  robot.agent = std::move(member.agent);
  robot.dds.agent = robot.agent.id;
  robot.dds.qos_directory = "qos";
  read_dds(top, robot.dds);
  robot.recording = read_recording(top);
  if (robot.recording) robot.recording->reader.ouster_metadata = robot.agent.perception.ouster.metadata;
  robot.ros = read_ros(top);
  top.has("keys");
  top.has("mission");  // irrelevant to the sensors
  top.finish();
  if (const Status status = document->status(); !status) return tl::unexpected(status.error());
  return robot;
}

}  // namespace fleetmap::config
