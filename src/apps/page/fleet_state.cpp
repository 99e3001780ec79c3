#include "fleet_state.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "fleetmap/agent/navigator.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kScanSilence = std::chrono::seconds(5);
/// Characters of a finding, which has its remedy as well, among a robot's problems.
constexpr std::size_t kMaxProblemLength = 120;
constexpr std::size_t kMaxFindings = 5;

/// The finding up to its first clause that ends, or its first words.
std::string in_short(const std::string& finding) {
  std::string first = finding.substr(0, std::min(finding.find("; "), finding.find(". ")));
  if (first.size() <= kMaxProblemLength) return first;
  const std::size_t blank = first.rfind(' ', kMaxProblemLength);
  first.resize(blank == std::string::npos ? kMaxProblemLength : blank);
  return first + " ...";
}

void add_findings(const std::vector<std::string>& findings, std::vector<std::string>& problems) {
  for (std::size_t k = 0; k < std::min(kMaxFindings, findings.size()); ++k)
    problems.push_back(in_short(findings[k]));
  if (findings.size() > kMaxFindings)
    problems.push_back(
        fmt::format("{} more findings of its sensors, which its log has", findings.size() - kMaxFindings));
}

void add_mission(const agent::Navigator& navigator, FleetState& fleet) {
  const planning::MissionExecutive& mission = navigator.executive();
  for (messages::MissionReport& report : mission.heard_reports()) {
    const AgentId from = report.from;
    fleet.reports.emplace(from, std::move(report));
  }
  fleet.reports.insert_or_assign(fleet.self, mission.report());
  fleet.rows = mission.plan().mission.rows;
  if (const auto reason = navigator.stop_reason()) fleet.stop_reason = to_string(*reason);
}

}  // namespace

std::vector<std::string> problems_of(const agent::Agent& agent, Stamp now) {
  std::vector<std::string> problems;
  const agent::Perception& perception = agent.perception();
  if (const Duration silence = now - perception.last_scan(); silence > kScanSilence)
    problems.push_back(fmt::format("no scan for {:.0f} s", to_seconds(silence)));
  if (const auto& loam = perception.odometry_counters(); loam.lost > 0)
    problems.push_back(fmt::format("the odometry could not match {} scans", loam.lost));
  if (const auto dropped = perception.counters().dropped_scans; dropped > 0)
    problems.push_back(fmt::format("{} scans were dropped, since the odometry is too slow", dropped));
  add_findings(perception.health().alarms(), problems);
  if (const auto failures = agent.store_failures(); failures > 0)
    problems.push_back(fmt::format("the disk refused {} writes", failures));
  return problems;
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
  if (agent.navigator() != nullptr) add_mission(*agent.navigator(), fleet);
  return fleet;
}

}  // namespace fleetmap::apps
