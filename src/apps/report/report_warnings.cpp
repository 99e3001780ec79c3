#include "report_warnings.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>

#include "fleetmap/core/text_list.hpp"
#include "report.hpp"

namespace fleetmap::apps {
namespace {

using nlohmann::json;

std::uint64_t count_in(const json& object, const char* key) { return object.value(key, std::uint64_t{0}); }

const json& part_of(const json& object, const char* key) {
  static const json none = json::object();
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

/// Warnings in order, each once.
class WarningList {
 public:
  void add(const std::string& sentence) {
    if (known_.insert(sentence).second) sentences_.push_back(sentence);
  }
  void add_if(std::uint64_t count, const std::string& sentence) {
    if (count > 0) add(sentence);
  }
  std::vector<std::string> take() { return std::move(sentences_); }

 private:
  std::set<std::string> known_;
  std::vector<std::string> sentences_;
};

void warn_of_results(const std::string& robot, const json& agent, WarningList& list) {
  if (agent.contains("problem")) {
    const std::string problem = agent["problem"].get<std::string>(), of_robot = robot + ": ";
    list.add(problem.starts_with(of_robot) ? problem : of_robot + problem);
  }
  if (agent.value("switched_off", false))
    list.add(robot + " was switched off before the end; of it only the store that it left is shown");
  if (agent.contains("own_nodes") && count_in(agent, "own_nodes") == 0)
    list.add(robot + " made no node: " + why_no_node(agent));
  else if (agent.contains("sensors") && count_in(agent["sensors"], "scans") == 0)
    list.add(robot + " made no node in this run, only before: " + why_no_node(agent));
  if (count_in(agent, "own_nodes") > 0 && !has_place_on_earth(robot, agent))
    list.add(robot + " has no place on Earth: " + why_no_place(agent));
  const std::uint64_t failures = count_in(agent, "store_failures");
  list.add_if(failures, robot + ": " + std::to_string(failures) +
                            " items could not be stored; check the disk's space and health");
}

void warn_of_sensors(const std::string& robot, const json& agent, WarningList& list) {
  for (const json& finding : part_of(agent, "recording").value("findings", json::array()))
    list.add(robot + ": " + finding.get<std::string>());
  const json& sensors = part_of(agent, "sensors");
  for (const json& finding : sensors.value("findings", json::array()))
    list.add(robot + ": " + finding.get<std::string>());
  odometry::LoamCounters odometry;
  odometry.updates = count_in(sensors, "odometry_updates");
  odometry.lost = count_in(sensors, "lost_scans");
  odometry.map_restarts = count_in(sensors, "local_maps_begun_anew");
  list.add_if(odometry.lost,
              robot + ": " + lost_ways(odometry) + "; drive slower there, or closer to what stands still");
  const std::uint64_t dropped = count_in(sensors, "dropped_scans");
  list.add_if(dropped,
              robot + ": " + std::to_string(dropped) +
                  " scans were dropped since the computer was too slow; see its load in report.json");
}

/// " (of r2: 3, r3: 1)", the makers of the submaps that a robot lacks.
std::string missing_of(const json& agent) {
  std::string makers;
  for (const auto& [maker, count] : part_of(agent, "missing_submaps_of").items())
    append_to_list(makers, maker + ": " + count.dump());
  return makers.empty() ? "" : " (of " + makers + ")";
}

void warn_of_exchange(const std::string& robot, const json& agent, WarningList& list) {
  const std::uint64_t missing = count_in(agent, "missing_submaps");
  list.add_if(missing, robot + ": " + std::to_string(missing) + " submaps are missing" + missing_of(agent) +
                           ", so its map has holes there, since their robots were out of Wi-Fi's reach; run "
                           "it again near one that has them");
  for (const auto& [topic, dropped] : part_of(agent, "bus_drops").items())
    list.add(
        fmt::format("{}: {} messages of {} were dropped by its own queues", robot, dropped.dump(), topic));
  for (const auto& [other, messages] : part_of(part_of(agent, "exchange"), "misbehaved").items())
    list.add(fmt::format(
        "{} refused {} messages of {} that no sound robot sends; check that robot's software and keys", robot,
        messages.dump(), other));
  for (const auto& [computer, credit] : part_of(agent, "alignments_computed_by").items()) {
    if (credit.value("quarantined", false))
      list.add(computer +
               " is in quarantine: the alignments that it computed contradict the others, and none "
               "is used; check its sensors and mounts");
  }
  for (const auto& [other, how] : part_of(agent, "contradict_the_fleet").items())
    list.add(
        fmt::format("{} contradicts the fleet{}; `fleetmap map info --without {}` shows the map without it",
                    other, how.value("left_out", false) ? " and is left out of the map" : "", other));
}

void warn_of_pairs(const std::vector<monitor::PairAnswer>& pairs, WarningList& list) {
  for (const monitor::PairAnswer& pair : pairs) {
    if (!monitor::is_joined(pair.state))
      list.add(pair.a.str() + " and " + pair.b.str() + " are not joined. " + pair.text);
  }
}

void warn_of_fleet(const json& report, WarningList& list) {
  if (!report.value("exchange_ended", true))
    list.add("the exchange did not come to its end within exchange_timeout, so that maps may be incomplete");
  std::set<std::string> maps;
  for (const auto& [robot, agent] : part_of(report, "agents").items()) {
    if (!agent.value("switched_off", false)) maps.insert(agent.value("map_hash", "none"));
  }
  if (maps.size() > 1) list.add("the robots hold different maps: not every robot received all submaps");
  const json& completion = part_of(report, "completion");
  if (completion.contains("why_not"))
    list.add("the mission was not completed: " + completion["why_not"].get<std::string>());
  for (const json& row : completion.value("abandoned_rows", json::array()))
    list.add("row " + row["row"].dump() + " was given up by " + row.value("agent", "") + ": " +
             row.value("why", ""));
  const json& access = part_of(report, "radio_access");
  if (access.value("who_may_join", "") == "anyone")
    list.add(
        "the robot has no keys: anyone on the radios may join, read all and send anything; make keys with "
        "`fleetmap keys`");
  for (const char* key : {"refused", "different_settings"})
    for (const json& sentence : access.value(key, json::array())) list.add(sentence.get<std::string>());
}

}  // namespace

bool has_place_on_earth(const std::string& robot, const json& agent) {
  if (!agent.contains("not_georeferenced")) return false;
  return std::ranges::none_of(agent.value("not_georeferenced", json::array()), [&](const json& frame) {
    const std::string name = frame.get<std::string>();
    return name.substr(0, name.find('#')) == robot;
  });
}

std::string why_no_node(const json& agent) {
  if (!agent.contains("sensors")) return "nobody knows why, since it was switched off";
  const json& sensors = agent["sensors"];
  const std::uint64_t scans = count_in(sensors, "scans");
  if (scans == 0) return "no LiDAR scan arrived; check the LiDAR, its driver and the topic";
  std::string lost;
  for (const auto& [key, words] : {std::pair{"refused_scans", "unusable"},
                                   {"dropped_scans", "dropped"},
                                   {"repeated_scans", "repeated"},
                                   {"lost_scans", "without a match"}}) {
    if (const std::uint64_t count = count_in(sensors, key); count > 0)
      append_to_list(lost, std::to_string(count) + " " + words);
  }
  return "none of " + std::to_string(scans) + " LiDAR scans led to one" +
         (lost.empty() ? "" : " (" + lost + ")") + "; see the log";
}

std::string why_no_place(const json& agent) {
  if (!agent.contains("not_georeferenced"))
    return "its map was not written, so nobody knows; see the log, and the space on its disk";
  const json& gps = part_of(agent, "localization");
  const std::uint64_t fixes = count_in(part_of(agent, "sensors"), "fixes"), used = count_in(gps, "fix_used");
  if (fixes == 0)
    return "no GPS fix arrived (check receiver, antenna and topic), and no alignment joins it to a robot "
           "with "
           "GPS";
  if (used > 0)
    return std::to_string(used) + " of " + std::to_string(fixes) +
           " GPS fixes were used, too few or over too short a way to know its heading";
  std::string why;
  for (const auto& [key, words] : {std::pair{"fix_invalid", "invalid"},
                                   {"fix_gated", "too far from where the robot was"},
                                   {"fix_implausible", "implausible"}}) {
    if (const std::uint64_t count = count_in(gps, key); count > 0)
      append_to_list(why, std::to_string(count) + " " + words);
  }
  return "none of " + std::to_string(fixes) + " GPS fixes could be used" +
         (why.empty() ? "" : " (" + why + ")") + ", and no alignment joins it to a robot with GPS";
}

std::vector<std::string> report_warnings(const json& report, const std::vector<monitor::PairAnswer>& pairs) {
  WarningList list;
  const json& agents = part_of(report, "agents");
  for (const auto& [robot, agent] : agents.items()) warn_of_results(robot, agent, list);
  warn_of_pairs(pairs, list);
  for (const auto& [robot, agent] : agents.items()) warn_of_sensors(robot, agent, list);
  warn_of_fleet(report, list);
  for (const auto& [robot, agent] : agents.items()) warn_of_exchange(robot, agent, list);
  return list.take();
}

}  // namespace fleetmap::apps
