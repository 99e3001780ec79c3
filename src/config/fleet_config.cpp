#include "fleetmap/config/fleet_config.hpp"

#include <algorithm>
#include <set>

#include "robot_sections.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {
namespace {

Result<Document> load_with(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = Document::load(file);
  if (!document) return document;
  if (const Status applied = document->apply(overrides); !applied) return tl::unexpected(applied.error());
  return document;
}

/// Everything but `agents`, `defaults` and the fleet's own keys is laid on every agent: that is where --set
/// goes.
YAML::Node agent_keys_of(const YAML::Node& root, const std::set<std::string>& fleet_keys) {
  YAML::Node keys(YAML::NodeType::Map);
  for (const auto& entry : root) {
    if (!fleet_keys.contains(entry.first.Scalar())) keys[entry.first] = entry.second;
  }
  return keys;
}

const std::set<std::string> kFleetKeys{"agents", "defaults", "network", "settle_time"};

Result<FleetConfig> read_fleet(Document& document) {
  FleetConfig fleet;
  Section top(document, document.root(), "");
  read_network(top, fleet.network);
  top.read("settle_time", fleet.settle_time);
  const YAML::Node& root = document.root();
  const YAML::Node defaults = root["defaults"];
  const YAML::Node agents = root["agents"];
  const YAML::Node everywhere = agent_keys_of(root, kFleetKeys);
  if (!agents.IsDefined() || !agents.IsSequence() || agents.size() == 0) {
    top.problem("agents", "expected a list with at least one agent: - {id: r1, recording: {path: ...}}");
    return tl::unexpected(document.status().error());
  }
  for (std::size_t k = 0; k < agents.size(); ++k) {
    const YAML::Node entry = merged(merged(defaults, agents[k]), everywhere);
    Section section(document, entry, "agents[" + std::to_string(k) + "]", agents[k].Mark());
    FleetConfig::Member member;
    read_agent(section, member.agent);
    if (section.has("directory"))
      section.problem("directory", "a run decides where its agents keep their files");
    if (section.has("fleet")) section.problem("fleet", "a fleet's file lists its agents under 'agents'");
    const auto recording = read_recording(section);
    if (!recording) section.problem("recording", "expected recording: {path: ...}");
    member.recording = recording;
    section.finish();
    for (const FleetConfig::Member& other : fleet.members) {
      if (other.agent.id == member.agent.id)
        section.problem("id", "'" + member.agent.id.str() + "' is taken by another agent");
    }
    fleet.members.push_back(std::move(member));
  }
  if (const Status status = document.status(); !status) return tl::unexpected(status.error());
  std::vector<AgentId> names;
  for (const FleetConfig::Member& member : fleet.members) names.push_back(member.agent.id);
  for (FleetConfig::Member& member : fleet.members) {
    member.agent.exchange.fleet = names;
    member.agent.directory = ".";  // the run puts its own folder here; the rest is checked
    if (const Status valid = member.agent.validate(); !valid) {
      return failure(document.name() + ": agent " + member.agent.id.str() + ": " + valid.error().message);
    }
    member.agent.directory.clear();
  }
  return fleet;
}

Result<RobotConfig> read_robot(Document& document) {
  RobotConfig robot;
  robot.dds.qos_directory = "qos";
  Section top(document, document.root(), "");
  read_agent(top, robot.agent);
  if (!top.has("id")) top.problem("id", "expected the robot's name, e.g. id: r1");
  robot.dds.agent = robot.agent.id;
  read_dds(top, robot.dds);
  robot.recording = read_recording(top);
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
  return robot;
}

}  // namespace

Result<Override> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return failure("--set " + text + ": expected key=value, e.g. lidar.model=os1-64");
  return Override{text.substr(0, equals), text.substr(equals + 1)};
}

Result<RobotConfig> load_robot(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = load_with(file, overrides);
  if (!document) return tl::unexpected(document.error());
  return read_robot(*document);
}

Result<FleetConfig> load_fleet(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = load_with(file, overrides);
  if (!document) return tl::unexpected(document.error());
  return read_fleet(*document);
}

Result<FleetConfig> fleet_of(const std::vector<std::pair<AgentId, std::filesystem::path>>& recordings,
                             const std::vector<Override>& overrides) {
  YAML::Node root(YAML::NodeType::Map);
  for (const auto& [id, path] : recordings) {
    YAML::Node entry(YAML::NodeType::Map);
    entry["id"] = id.str();
    entry["recording"]["path"] = path.string();
    root["agents"].push_back(entry);
  }
  Document document = Document::from(root, "command line");
  if (const Status applied = document.apply(overrides); !applied) return tl::unexpected(applied.error());
  return read_fleet(document);
}

Result<RobotConfig> load_sensors(const std::optional<std::filesystem::path>& file,
                                 const std::vector<Override>& overrides) {
  Result<Document> document = Document::from(YAML::Node(YAML::NodeType::Map), "command line");
  if (file) document = Document::load(*file);
  if (!document) return tl::unexpected(document.error());
  if (const Status applied = document->apply(overrides); !applied) return tl::unexpected(applied.error());
  const YAML::Node& root = document->root();
  YAML::Node entry = root;
  if (root["agents"].IsDefined() && root["agents"].IsSequence() && root["agents"].size() > 0) {
    entry = merged(merged(root["defaults"], root["agents"][0]), agent_keys_of(root, kFleetKeys));
  }
  Section top(*document, entry, "");
  RobotConfig robot;
  robot.agent.id = AgentId::parse("r1").value();
  read_agent(top, robot.agent);
  robot.dds.agent = robot.agent.id;
  robot.dds.qos_directory = "qos";
  read_dds(top, robot.dds);
  robot.recording = read_recording(top);
  top.finish();
  if (const Status status = document->status(); !status) return tl::unexpected(status.error());
  return robot;
}

Result<FileKind> check(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = load_with(file, overrides);
  if (!document) return tl::unexpected(document.error());
  const YAML::Node& root = document->root();
  if (root["agents"].IsDefined()) {
    const auto fleet = read_fleet(*document);
    if (!fleet) return tl::unexpected(fleet.error());
    return FileKind::kFleet;
  }
  const auto robot = read_robot(*document);
  if (!robot) return tl::unexpected(robot.error());
  return FileKind::kRobot;
}

}  // namespace fleetmap::config
