#include "fleetmap/config/fleet_file.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "agent_keys.hpp"
#include "agent_sections.hpp"
#include "document_kind.hpp"
#include "field_section.hpp"
#include "fleet_document.hpp"
#include "fleetmap/config/fleet_agreement.hpp"
#include "keys_section.hpp"
#include "loopback_domains.hpp"
#include "network_section.hpp"
#include "recording_section.hpp"
#include "ros_section.hpp"
#include "twin_sections.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {
namespace {

/// "file:line: key", for what is found wrong only when worlds are built and missions planned.
std::string place_of(const Document& document, const YAML::Mark& mark, const std::string& key) {
  // GCC 12 warns of ":" + std::to_string() where it inlines both.
  std::string place = document.name();
  if (!mark.is_null()) place.append(":").append(std::to_string(mark.line + 1));
  return place.append(": ").append(key);
}

/// One entry of `agents`: `entry` is `own` laid on the defaults.
FleetConfig::Member read_member(Section& section, const YAML::Node& own, const std::string& path,
                                bool in_twin, const Document& document) {
  FleetConfig::Member member;
  read_agent(section, member.agent);
  if (section.has("directory"))
    section.problem("directory", "a run decides where its agents keep their files");
  if (section.has("fleet")) section.problem("fleet", "a fleet's file lists its agents under 'agents'");
  member.recording = read_recording(section);
  if (member.recording) member.recording->reader.ouster_metadata = member.agent.perception.ouster.metadata;
  member.ros = read_ros(section);
  read_robot_twin(section, member.robot, member.switched_off);
  if (!in_twin && !member.recording)
    section.problem("recording",
                    "expected recording: {path: ...}, or for the whole fleet world: {file: ...}");
  if (in_twin) suit_estimator(member, section.section("lidar"));
  if (!in_twin && !member.switched_off.empty())
    section.problem("robot", "switched_off is for the twin, which needs world: {file: WORLD.yaml}");
  if (in_twin && member.recording)
    section.problem("recording", "a fleet of the twin (world) has no recordings");
  section.finish();
  const YAML::Node robot = own.IsMap() ? own["robot"] : YAML::Node();
  member.robot_at =
      place_of(document, robot.IsDefined() && robot.IsMap() ? robot.Mark() : own.Mark(), path + ".robot");
  return member;
}

/// Completes the members with what follows from all of them, and checks them.
Status finish_members(FleetConfig& fleet, const std::string& file) {
  std::vector<AgentId> names;
  for (const FleetConfig::Member& member : fleet.members) names.push_back(member.agent.id);
  for (const RadioBlackout& blackout : fleet.blackouts) {
    if (blackout.agent && std::ranges::find(names, *blackout.agent) == names.end())
      return failure(file + ": network.blackouts: agent '" + blackout.agent->str() + "' is not in agents");
  }
  for (FleetConfig::Member& member : fleet.members) {
    member.agent.exchange.fleet = names;
    member.dds.settings = fleet_settings(member.agent);
    member.agent.directory = ".";  // the run puts its own folder here; the rest is checked
    if (const Status valid = member.agent.validate(); !valid) {
      return failure(file + ": agent " + member.agent.id.str() + ": " + valid.error().message);
    }
    member.agent.directory.clear();
  }
  return {};
}

}  // namespace

Result<FleetConfig> read_fleet(Document& document) {
  FleetConfig fleet;
  Section top(document, document.root(), "");
  read_network(top, fleet.network, fleet.blackouts);
  top.read("exchange_timeout", fleet.exchange_timeout);
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
    const std::string path = "agents[" + std::to_string(k) + "]";
    Section section(document, merged(merged(defaults, agents[k]), everywhere), path, agents[k].Mark());
    FleetConfig::Member member = read_member(section, agents[k], path, fleet.twin.has_value(), document);
    member.dds = dds_of(member.agent.id, k, domains);
    read_keys(top, /*of_fleet=*/true, member.agent, member.dds);
    for (const FleetConfig::Member& other : fleet.members) {
      if (other.agent.id == member.agent.id)
        section.problem("id", "'" + member.agent.id.str() + "' is taken by another agent");
    }
    fleet.members.push_back(std::move(member));
  }
  if (const Status status = document.status(); !status) return tl::unexpected(status.error());
  if (const Status status = finish_members(fleet, document.name()); !status)
    return tl::unexpected(status.error());
  return fleet;
}

Result<FleetConfig> load_fleet(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = load_with(file, overrides);
  if (!document) return tl::unexpected(document.error());
  if (const Status expected = expect_kind(*document, {FileKind::kFleet}, "a fleet"); !expected)
    return tl::unexpected(expected.error());
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

}  // namespace fleetmap::config
