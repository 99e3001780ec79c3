#include "robot_states.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "fleetmap/sensor/clock_offsets.hpp"
#include "row_progress.hpp"

namespace fleetmap::apps {
namespace {

using messages::Hold;
using messages::MissionReport;
using messages::MissionState;

std::string words_of_row(const planning::Row& row, const MissionReport& report,
                         std::optional<double> heading) {
  if (!heading) return fmt::format("drives row {}", row.id);
  const auto driven = row_progress(row, report.position, *heading);
  return driven ? fmt::format("drives row {} ({:.0f} % of it)", row.id, 100.0 * *driven)
                : fmt::format("is on its way to row {}", row.id);
}

/// Reports do not contain whether the robot has arrived, but its position.
std::string words_of_way_home(const MissionReport& report, const std::optional<Eigen::Vector2d>& start) {
  constexpr double kThere_m = 5.0;
  if (!start) return "";
  const double distance = (report.position - *start).norm();
  return distance < kThere_m ? ": it is back at its start"
                             : fmt::format(": {:.0f} m from its start", distance);
}

std::string words_of(const MissionReport& report, const std::vector<planning::Row>& rows,
                     std::optional<double> heading, const std::optional<Eigen::Vector2d>& start) {
  switch (report.state) {
    case MissionState::kDriving:
      return report.current < rows.size() ? words_of_row(rows[report.current], report, heading)
                                          : "is between two rows";
    case MissionState::kMeeting:
      return "waits where all meet";
    case MissionState::kDone:
      return "is done";
    case MissionState::kStuck:
      return "is stuck and gave its rows away";
    case MissionState::kLowBattery:
      return "drives home with a low battery" + words_of_way_home(report, start);
    case MissionState::kCalledHome:
      return "was called home and gave its rows away" + words_of_way_home(report, start);
    case MissionState::kLost:
      break;
  }
  return "is lost";
}

std::string activity_now(const FleetState& fleet, const AgentId& id, bool is_held, bool called_home) {
  const auto report = fleet.reports.find(id);
  if (id == fleet.self && !fleet.stop_reason.empty()) return "stands still: " + fleet.stop_reason;
  if (is_held)
    return std::string("stands still: an operator holds it") + (called_home ? " on its way home" : "");
  const auto status = fleet.statuses.find(id);
  if (report != fleet.reports.end()) {
    const auto start = fleet.starts.find(id);
    return activity_of(
        report->second, fleet.rows,
        status == fleet.statuses.end() ? std::nullopt : std::optional<double>(status->second.heading),
        start == fleet.starts.end() ? std::nullopt : std::optional(start->second));
  }
  if (status == fleet.statuses.end()) return "was not heard yet";
  return status->second.busy ? "maps" : "has nothing left to map or to exchange";
}

std::vector<std::uint32_t> rows_of(const MissionReport& report, const std::vector<planning::Row>& rows) {
  std::vector<std::uint32_t> ids;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (report.claimed.has(row)) ids.push_back(rows[row].id);
  }
  return ids;
}

/// Orders that the robot has not confirmed by what it does.
void add_unconfirmed(const FleetState& fleet, bool is_stationary, bool on_way_home,
                     monitor::RobotNow& robot) {
  if (robot.driven && robot.ordered_to_hold && !is_stationary)
    robot.problems.emplace_back("has not confirmed the order to stand still");
  if (robot.driven && robot.called_home && !robot.ordered_to_hold && !on_way_home)
    robot.problems.emplace_back("has not confirmed the order to drive home");
  const auto report = fleet.reports.find(robot.id);
  if (report == fleet.reports.end()) return;
  for (const messages::RowOrder& order : fleet.row_orders) {
    const auto row = std::ranges::find(fleet.rows, order.row, &planning::Row::id);
    const auto index = static_cast<std::size_t>(row - fleet.rows.begin());
    const bool owns = report->second.claimed.has(index) || report->second.done.has(index);
    if (order.to == robot.id && row != fleet.rows.end() && !owns)
      robot.problems.push_back(fmt::format("has not taken over row {} yet", order.row));
  }
}

std::vector<monitor::LastHeard> heard_of(const FleetState& fleet, const AgentId& id) {
  std::vector<monitor::LastHeard> all;
  for (const auto& [source, heard] : fleet.heard)
    if (source.second == id) all.push_back({bus::to_string(source.first), to_seconds(fleet.now - heard.at)});
  std::ranges::sort(all, {}, &monitor::LastHeard::seconds_ago);
  return all;
}

void add_status(const messages::AgentStatus& status, monitor::RobotNow& robot) {
  robot.nodes = status.nodes;
  robot.alignments = status.alignments;
  robot.submaps = status.submaps;
  robot.backlog_bytes = status.backlog_bytes;
  if (status.battery >= 0.0f) robot.battery = status.battery;
  if (status.position_stddev > 0.0f) {
    robot.sigma_m = status.position_stddev;
    robot.place = {status.position, status.heading, status.stamp};
  }
  if (const auto behind = messages::seconds_behind(status.health.clock_offset)) {
    robot.clock = {sensor::to_string(static_cast<sensor::Source>(status.health.clock_sensor)), *behind};
  }
}

/// Adds problems of now, and totals: problems of any time since the robot started.
void add_health(const FleetState& fleet, monitor::RobotNow& robot) {
  constexpr std::uint8_t kTotals =
      messages::Health::kScansNotMatched | messages::Health::kScansDropped | messages::Health::kDiskRefuses;
  if (const auto messages = fleet.misbehaved.find(robot.id); messages != fleet.misbehaved.end())
    robot.totals.push_back(fmt::format("sent {} messages that contradict the rules", messages->second));
  if (const auto known = fleet.problems.find(robot.id); known != fleet.problems.end()) {
    robot.problems.insert(robot.problems.end(), known->second.begin(), known->second.end());
    if (const auto totals = fleet.totals.find(robot.id); totals != fleet.totals.end())
      robot.totals.insert(robot.totals.end(), totals->second.begin(), totals->second.end());
  } else if (const auto status = fleet.statuses.find(robot.id); status != fleet.statuses.end()) {
    messages::Health now = status->second.health, since_start = now;
    now.problems &= static_cast<std::uint8_t>(~kTotals);
    since_start.problems &= kTotals;
    for (std::string& words : messages::words_of(now)) robot.problems.push_back(std::move(words));
    for (std::string& words : messages::words_of(since_start)) robot.totals.push_back(std::move(words));
  }
  robot.problems.insert(robot.problems.end(), robot.totals.begin(), robot.totals.end());
}

monitor::RobotNow robot_now(const FleetState& fleet, const AgentId& id) {
  monitor::RobotNow robot;
  robot.id = id;
  if (const auto status = fleet.statuses.find(id); status != fleet.statuses.end())
    add_status(status->second, robot);
  const auto order = orders::order_for(id, fleet.orders);
  robot.ordered_to_hold = order && order->stops();
  robot.called_home = order && order->calls_home();
  if (const auto report = fleet.reports.find(id); report != fleet.reports.end())
    robot.rows = rows_of(report->second, fleet.rows);
  const auto driving = fleet.driving.find(id);
  const bool answered = driving != fleet.driving.end();
  // A robot that has not said yet what it does can be stopped, too.
  robot.driven = !answered || driving->second != Hold::Driving::kNoMission;
  const bool is_held = answered && driving->second == Hold::Driving::kHeld && robot.ordered_to_hold;
  robot.activity = activity_now(fleet, id, is_held, robot.called_home);
  add_unconfirmed(fleet, is_held, answered && driving->second == Hold::Driving::kHome, robot);
  add_health(fleet, robot);
  robot.heard = heard_of(fleet, id);
  return robot;
}

}  // namespace

std::string activity_of(const MissionReport& report, const std::vector<planning::Row>& rows,
                        std::optional<double> heading, std::optional<Eigen::Vector2d> start) {
  const std::string words = words_of(report, rows, heading, start);
  if (rows.empty()) return words;
  const messages::RowSet done(rows.size(), report.done.bytes());  // it may be of a longer mission
  const double share = static_cast<double>(done.count()) / static_cast<double>(rows.size());
  return fmt::format("{}, {:.0f} % of the rows are driven", words, 100.0 * share);
}

void add_silence(double lost_after, monitor::RobotNow& robot) {
  if (!robot.heard.empty() && robot.heard.front().seconds_ago > lost_after)
    robot.problems.emplace(robot.problems.begin(), "is heard on no radio");
}

std::vector<monitor::RobotNow> robot_states(const FleetState& fleet) {
  std::vector<AgentId> names = fleet.fleet;
  std::ranges::sort(names);
  std::vector<monitor::RobotNow> robots;
  for (const AgentId& id : names) robots.push_back(robot_now(fleet, id));
  return robots;
}

}  // namespace fleetmap::apps
