#include "fleet_state.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "fleetmap/agent/navigator.hpp"
#include "sensor_findings.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kScanSilence = std::chrono::seconds(5);
constexpr std::size_t kMaxFindings = 5;

/// Findings whose cause has not ended.
void add_findings(const std::vector<SensorFinding>& findings, std::vector<std::string>& problems) {
  std::size_t present = 0;
  for (const SensorFinding& one : findings) {
    if (!one.is_over && ++present <= kMaxFindings) problems.push_back(one.text);
  }
  if (present > kMaxFindings)
    problems.push_back(
        fmt::format("{} more findings of its sensors, which its log has", present - kMaxFindings));
}

void add_mission(const agent::Navigator& navigator, FleetState& fleet) {
  const planning::MissionExecutive& mission = navigator.executive();
  for (messages::MissionReport& report : mission.heard_reports()) {
    const AgentId from = report.from;
    fleet.reports.emplace(from, std::move(report));
  }
  fleet.reports.insert_or_assign(fleet.self, mission.report());
  fleet.rows = mission.plan().mission.rows;
  for (const planning::RobotAbility& robot : mission.plan().fleet)
    fleet.starts.emplace(robot.id, robot.start.position);
  if (const auto reason = navigator.stop_reason()) fleet.stop_reason = to_string(*reason);
}

}  // namespace

std::vector<std::string> problems_of(const agent::Agent& agent, Stamp now) {
  std::vector<std::string> problems;
  const agent::Perception& perception = agent.perception();
  if (const Duration silence = now - perception.last_scan(); silence > kScanSilence)
    problems.push_back(fmt::format("no scan for {:.0f} s", to_seconds(silence)));
  add_findings(sensor_findings(perception, now), problems);
  return problems;
}

std::vector<std::string> totals_of(const agent::Agent& agent) {
  std::vector<std::string> totals;
  const agent::Perception& perception = agent.perception();
  if (const auto& loam = perception.odometry_counters(); loam.lost > 0)
    totals.push_back(fmt::format("the odometry could not match {} scans", loam.lost));
  if (const auto dropped = perception.counters().dropped_scans; dropped > 0)
    totals.push_back(fmt::format("{} scans were dropped, since the odometry is too slow", dropped));
  if (const auto failures = agent.store_failures(); failures > 0)
    totals.push_back(fmt::format("the disk refused {} writes", failures));
  return totals;
}

double lost_after(const agent::Agent& agent) {
  if (agent.navigator() != nullptr) return agent.navigator()->executive().plan().config.executive.lost_after;
  const exchange::ExchangeConfig& config = agent.config().exchange;
  return to_seconds(exchange::for_fleet(config.reconcile.peer_timeout, config));
}

FleetState fleet_state(const agent::Agent& agent, const std::map<LinkLog::Source, LinkLog::Heard>& last_heard,
                       Stamp now) {
  const exchange::Exchange& exchange = agent.exchange();
  FleetState fleet;
  fleet.self = agent.config().id;
  fleet.fleet = agent.config().exchange.fleet;
  fleet.now = now;
  fleet.statuses = exchange.statuses();
  fleet.driving = exchange.driving();
  fleet.orders = exchange.hold_orders();
  fleet.row_orders = exchange.row_orders();
  fleet.heard = last_heard;
  fleet.misbehaved = exchange.stats().misbehaved;
  fleet.problems[fleet.self] = problems_of(agent, now);
  fleet.totals[fleet.self] = totals_of(agent);
  if (agent.navigator() != nullptr) add_mission(*agent.navigator(), fleet);
  return fleet;
}

}  // namespace fleetmap::apps
