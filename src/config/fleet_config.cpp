#include "fleetmap/config/fleet_config.hpp"

#include <algorithm>
#include <set>

#include "field_section.hpp"
#include "fleetmap/config/experiment_config.hpp"
#include "fleetmap/config/sensor_file.hpp"
#include "fleetmap/config/world_config.hpp"
#include "mission_section.hpp"
#include "robot_sections.hpp"
#include "twin_sections.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {
namespace {

Result<Document> load_with(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = Document::load(file);
  if (!document) return document;
  if (const Status applied = document->apply(overrides); !applied) return tl::unexpected(applied.error());
  return document;
}

/// Nothing: the keys could be any file's.
std::optional<FileKind> kind_of(const YAML::Node& root) {
  const auto has = [&](const char* key) { return root.IsMap() && root[key].IsDefined(); };
  if (has("agents")) return FileKind::kFleet;
  if (has("studies")) return FileKind::kExperiment;
  if (has("kind")) return FileKind::kWorld;
  if (has("elevations_deg") || has("pattern") || has("field_of_view_deg")) return FileKind::kSensor;
  if (has("id")) return FileKind::kRobot;
  return std::nullopt;
}

const char* name_of(FileKind kind) {
  switch (kind) {
    case FileKind::kRobot:
      return "an agent";
    case FileKind::kFleet:
      return "a fleet";
    case FileKind::kWorld:
      return "a world";
    case FileKind::kSensor:
      return "a sensor";
    case FileKind::kExperiment:
      return "an experiment";
  }
  return "";
}

Status expect_kind(const Document& document, std::initializer_list<FileKind> wanted, const char* remedy) {
  const auto kind = kind_of(document.root());
  if (!kind || std::ranges::find(wanted, *kind) != wanted.end()) return {};
  return failure(document.name() + ": this is " + name_of(*kind) + "; give " + remedy);
}

/// What an agent's file, entry or defaults may hold.
std::set<std::string> agent_keys() {
  const YAML::Node nothing(YAML::NodeType::Map);
  Document document = Document::from(nothing, "");
  Section section(document, nothing, "");
  FleetConfig::Member member;
  read_agent(section, member.agent);
  read_recording(section);
  read_robot_twin(section, member.robot, member.switched_off);
  return section.asked_for();
}

/// An agent's keys at the top of a fleet's file are laid on every agent: that is where --set goes.
YAML::Node agent_keys_of(const YAML::Node& root, const std::set<std::string>& known) {
  YAML::Node keys(YAML::NodeType::Map);
  for (const auto& entry : root) {
    if (known.contains(entry.first.Scalar())) keys[entry.first] = entry.second;
  }
  return keys;
}

/// The odometry is told of the LiDAR that the twin carries, where the configuration does not say otherwise.
void suit_estimator(FleetConfig::Member& member, Section lidar) {
  agent::PerceptionConfig& perception = member.agent.perception;
  if (!lidar.has("model")) {
    if (const auto model = odometry::lidar_model(member.robot.lidar.model)) perception.lidar = *model;
  }
  if (!lidar.has("scan_period")) perception.lidar.scan_period = 1.0 / member.robot.lidar.rate;
}

std::optional<TwinConfig> read_twin(Section& top) {
  if (!top.has("world")) {
    for (const char* key : {"mission", "max_time"}) {
      if (top.has(key)) top.problem(key, "of a fleet is for the twin, which needs world: {file: WORLD.yaml}");
    }
    return std::nullopt;
  }
  TwinConfig twin;
  Section world = top.section("world");
  world.read_path("file", twin.world);
  if (twin.world.empty()) {
    world.problem("file", "expected the world's file, e.g. ../worlds/farm_200.yaml");
  } else if (const auto reason = unreadable(twin.world)) {
    world.problem("file", twin.world.string() + ": " + *reason + "; expected the world's file");
  }
  if (world.has("seed")) {
    std::uint64_t seed = 0;
    world.read("seed", seed);
    twin.seed = seed;
  }
  world.finish();
  read_mission(top, twin);
  top.read("max_time", twin.max_time);
  if (!(twin.max_time > 0.0)) top.problem("max_time", "expected seconds > 0");
  return twin;
}

/// The profiles of the links; an agent reads them when it starts.
void check_profiles(Section& dds, const std::filesystem::path& folder) {
  for (const char* link : {"onboard", "long_range", "short_range"}) {
    const std::filesystem::path file = folder / (std::string(link) + ".xml");
    const auto reason = unreadable(file);
    if (!reason) continue;
    return dds.problem("qos", file.string() + ": " + *reason +
                                  "; expected the folder of the links' profiles (qos/ of fleetmap), relative "
                                  "to this file or with its whole path");
  }
}

/// Every robot on this machine: an onboard domain each, the radios shared, all over the loopback.
struct LoopbackDomains {
  std::uint32_t base = 40;
  std::filesystem::path qos = "qos";
};

LoopbackDomains read_loopback(Section& top) {
  LoopbackDomains domains;
  Section dds = top.section("dds");
  dds.read("base_domain", domains.base);
  dds.read_path("qos", domains.qos);
  dds.finish();
  if (dds.has("qos")) check_profiles(dds, domains.qos);
  if (domains.base > 200) dds.problem("base_domain", "expected at most 200: DDS has domains up to 232");
  return domains;
}

/// "file:line: key", for what is found wrong only when worlds are built and missions planned.
std::string place_of(const Document& document, const YAML::Mark& mark, const std::string& key) {
  const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
  return document.name() + line + ": " + key;
}

bus::DdsBusConfig dds_of(const AgentId& agent, std::size_t index, const LoopbackDomains& domains) {
  bus::DdsBusConfig dds;
  dds.agent = agent;
  dds.qos_directory = domains.qos;
  const auto domain = [&](std::size_t offset) { return static_cast<int>(domains.base + offset); };
  dds.long_range.domain = domain(0);
  dds.short_range.domain = domain(1);
  dds.onboard.domain = domain(2 + index);
  dds.long_range.address = dds.short_range.address = "127.0.0.1";
  dds.long_range.peers = dds.short_range.peers = {"127.0.0.1"};
  return dds;
}

Result<FleetConfig> read_fleet(Document& document) {
  FleetConfig fleet;
  Section top(document, document.root(), "");
  read_network(top, fleet.network, fleet.blackouts);
  top.read("settle_time", fleet.settle_time);
  fleet.twin = read_twin(top);
  fleet.field = read_field(top);
  const LoopbackDomains domains = read_loopback(top);
  const YAML::Node& root = document.root();
  const YAML::Node defaults = root["defaults"];
  const YAML::Node agents = root["agents"];
  const YAML::Node mission = root["mission"];
  if (fleet.twin) {
    fleet.twin->mission_at =
        place_of(document, mission.IsDefined() ? mission.Mark() : YAML::Mark::null_mark(), "mission");
  }
  const std::set<std::string> known = agent_keys();
  const YAML::Node everywhere = agent_keys_of(root, known);
  document.share(defaults, "agents", "defaults");
  document.share(everywhere, "agents", "");
  top.has("agents");
  top.has("keys");
  top.has("defaults");
  top.allow(known);
  top.finish();
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
    member.recording = read_recording(section);
    read_robot_twin(section, member.robot, member.switched_off);
    if (!fleet.twin && !member.recording)
      section.problem("recording",
                      "expected recording: {path: ...}, or for the whole fleet world: {file: ...}");
    if (fleet.twin) suit_estimator(member, section.section("lidar"));
    if (!fleet.twin && !member.switched_off.empty())
      section.problem("robot", "switched_off is for the twin, which needs world: {file: WORLD.yaml}");
    if (fleet.twin && member.recording)
      section.problem("recording", "a fleet of the twin (world) has no recordings");
    section.finish();
    const YAML::Node robot = agents[k].IsMap() ? agents[k]["robot"] : YAML::Node();
    member.robot_at = place_of(document, robot.IsDefined() && robot.IsMap() ? robot.Mark() : agents[k].Mark(),
                               "agents[" + std::to_string(k) + "].robot");
    member.dds = dds_of(member.agent.id, k, domains);
    read_keys(top, /*of_fleet=*/true, member.agent, member.dds);
    for (const FleetConfig::Member& other : fleet.members) {
      if (other.agent.id == member.agent.id)
        section.problem("id", "'" + member.agent.id.str() + "' is taken by another agent");
    }
    fleet.members.push_back(std::move(member));
  }
  if (const Status status = document.status(); !status) return tl::unexpected(status.error());
  std::vector<AgentId> names;
  for (const FleetConfig::Member& member : fleet.members) names.push_back(member.agent.id);
  for (const RadioBlackout& blackout : fleet.blackouts) {
    if (blackout.agent && std::ranges::find(names, *blackout.agent) == names.end())
      return failure(document.name() + ": network.blackouts: agent '" + blackout.agent->str() +
                     "' is not in agents");
  }
  for (FleetConfig::Member& member : fleet.members) {
    member.agent.exchange.fleet = names;
    member.dds.settings = fleet_settings(member.agent);
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
  read_keys(top, /*of_fleet=*/false, robot.agent, robot.dds);
  robot.agent.exchange.long_range.multicast = robot.dds.long_range.multicast;
  robot.dds.long_range.fleet_bits_per_second = 8.0 * robot.agent.exchange.long_range.fleet_bytes_per_second;
  Section dds = top.section("dds");
  if (dds.has("qos")) check_profiles(dds, robot.dds.qos_directory);
  robot.recording = read_recording(top);
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

}  // namespace

void FleetConfig::keep_first(std::size_t count) {
  members.resize(std::min(count, members.size()));
  std::vector<AgentId> names;
  for (const Member& member : members) names.push_back(member.agent.id);
  for (Member& member : members) {
    member.agent.exchange.fleet = names;
    std::erase_if(member.agent.exchange.on_radio,
                  [&](const AgentId& id) { return std::ranges::find(names, id) == names.end(); });
    member.dds.settings = fleet_settings(member.agent);
  }
}

Result<Override> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return failure("--set " + text + ": expected key=value, e.g. lidar.model=os1-64");
  return Override{text.substr(0, equals), text.substr(equals + 1)};
}

Result<RobotConfig> load_robot(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = load_with(file, overrides);
  if (!document) return tl::unexpected(document.error());
  const Status expected = expect_kind(*document, {FileKind::kRobot},
                                      "an agent, or of a fleet the name of one of its agents (--as r1)");
  if (!expected) return tl::unexpected(expected.error());
  return read_robot(*document);
}

Result<FleetConfig> load_fleet(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = load_with(file, overrides);
  if (!document) return tl::unexpected(document.error());
  if (const Status expected = expect_kind(*document, {FileKind::kFleet}, "a fleet"); !expected)
    return tl::unexpected(expected.error());
  return read_fleet(*document);
}

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
  top.has("keys");
  top.has("mission");  // of no concern to the sensors
  top.finish();
  if (const Status status = document->status(); !status) return tl::unexpected(status.error());
  return robot;
}

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
