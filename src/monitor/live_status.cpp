#include "fleetmap/monitor/live_status.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "candidates_json.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "names_json.hpp"
#include "rounded_json.hpp"

namespace fleetmap::monitor {
namespace {

using nlohmann::json;

json clock_json(const std::optional<ClockNow>& clock) {
  return clock ? json{{"sensor", clock->sensor}, {"behind_s", clock->behind_s}} : json();
}

/// Latitude and longitude in degrees, altitude in m, heading in rad, stamp in s; 1e-7 degrees are a
/// centimetre.
json place_json(const std::optional<PlaceNow>& place) {
  if (!place) return {};
  const GeoPoint& at = place->position;
  return {rounded(at.latitude / kDegree, 1e8), rounded(at.longitude / kDegree, 1e8),
          rounded(at.altitude, 1e2), rounded(place->heading, 1e3), rounded(to_seconds(place->stamp), 1e2)};
}

json past_json(const std::vector<PastProblem>& past) {
  json problems = json::array();
  for (const PastProblem& one : past)
    problems.push_back(
        {{"text", one.text}, {"total", one.is_total}, {"seconds_ago", optional_json(one.seconds_ago, 1.0)}});
  return problems;
}

json robot_json(const RobotNow& robot) {
  json heard = json::array();
  for (const LastHeard& one : robot.heard)
    heard.push_back({{"link", one.link}, {"seconds_ago", rounded(one.seconds_ago, 10.0)}});
  return {{"id", robot.id.str()},
          {"activity", robot.activity},
          {"problems", robot.problems},
          {"past_problems", past_json(robot.past)},
          {"heard", std::move(heard)},
          {"battery", optional_json(robot.battery, 1e3)},
          {"sigma_m", optional_json(robot.sigma_m, 1e3)},
          {"place", place_json(robot.place)},
          {"clock", clock_json(robot.clock)},
          {"nodes", robot.nodes},
          {"alignments", robot.alignments},
          {"submaps", robot.submaps},
          {"backlog_bytes", robot.backlog_bytes},
          {"ordered_to_hold", robot.ordered_to_hold},
          {"called_home", robot.called_home},
          {"rows", robot.rows},
          {"driven", robot.driven}};
}

json sensor_json(const SensorNow& sensor) {
  json findings = json::array();
  for (const FindingNow& one : sensor.findings)
    findings.push_back({{"text", one.text}, {"over", one.is_over}});
  return {{"name", sensor.name},
          {"samples", sensor.samples},
          {"per_second", rounded(sensor.per_second, 10.0)},
          {"clock_behind_s", optional_json(sensor.clock_behind_s, 1e3)},
          {"clock_slow_ppm", optional_json(sensor.clock_slow_ppm, 10.0)},
          {"findings", std::move(findings)}};
}

json radio_json(const RadioNow& radio) {
  json queues = json::array(), kinds = json::array(), peers = json::array();
  for (const QueueNow& one : radio.queues)
    queues.push_back({{"priority", one.priority}, {"waiting", one.waiting}, {"dropped", one.dropped}});
  for (const KindRate& one : radio.kinds) {
    kinds.push_back({{"link", one.link},
                     {"kind", one.kind},
                     {"sent", rounded(one.sent, 10.0)},
                     {"received", rounded(one.received, 10.0)}});
  }
  for (const PeerRate& one : radio.peers) {
    peers.push_back({{"robot", one.peer.str()},
                     {"link", one.link},
                     {"received", rounded(one.received, 10.0)},
                     {"loss", rounded(one.loss, 1e4)},
                     {"delay_s", optional_json(one.delay_s, 1e4)}});
  }
  return {{"who_may_join", radio.who_may_join},
          {"sent", rounded(radio.sent, 10.0)},
          {"received", rounded(radio.received, 10.0)},
          {"share", rounded(radio.share, 10.0)},
          {"fleet_budget", rounded(radio.fleet_budget, 10.0)},
          {"backlog_bytes", radio.backlog_bytes},
          {"backlog_s", optional_json(radio.backlog_s, 10.0)},
          {"queues", std::move(queues)},
          {"kinds", std::move(kinds)},
          {"peers", std::move(peers)},
          {"missing_submaps", radio.missing_submaps},
          {"missing_bytes", radio.missing_bytes},
          {"seconds_to_equal_map", optional_json(radio.seconds_to_equal_map, 1.0)}};
}

json maps_json(const FleetMaps& maps) {
  return {{"last", maps.last ? json(maps.last->str()) : json()},
          {"missing_submaps", maps.missing_submaps},
          {"seconds_to_equal", optional_json(maps.seconds_to_equal, 1.0)},
          {"not_counted", names_json(maps.not_counted)}};
}

}  // namespace

std::string live_json(const LiveStatus& status, bool operated) {
  json robots = json::array(), sensors = json::array();
  for (const RobotNow& robot : status.robots) robots.push_back(robot_json(robot));
  for (const SensorNow& sensor : status.sensors) sensors.push_back(sensor_json(sensor));
  const json live{{"self", status.self.str()},
                  {"lost_after_s", rounded(status.lost_after_s, 10.0)},
                  {"robots", std::move(robots)},
                  {"sensors", std::move(sensors)},
                  {"radio", radio_json(status.radio)},
                  {"maps", maps_json(status.maps)},
                  {"candidates", candidates_json(status.candidates)},
                  {"operated", operated}};
  return json{{"live", live}}.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace fleetmap::monitor
