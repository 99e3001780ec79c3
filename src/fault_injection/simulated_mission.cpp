#include "simulated_mission.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fleetmap/planning/mission/fleet_plan.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr double kRowLength = 60.0;  // m
/// m. Nodes along a row do not tell it from a near one.
constexpr double kRowDistance = 20.0;
constexpr std::size_t kRowsEach = 2;
constexpr double kStep = 0.5;  // m
/// Share of a row's metres without which it counts as not driven: nodes near most of a row are evidence.
constexpr double kDriven = 0.4;

std::shared_ptr<const planning::FleetPlan> plan_of(const std::vector<AgentId>& fleet) {
  planning::Mission mission;
  for (std::size_t k = 0; k < kRowsEach * fleet.size(); ++k) {
    const double north = kRowDistance * static_cast<double>(k);
    mission.rows.push_back(
        {static_cast<planning::RowId>(k), {Eigen::Vector2d(0.0, north), Eigen::Vector2d(kRowLength, north)}});
  }
  std::vector<planning::RobotAbility> abilities;
  for (const AgentId& agent : fleet) {
    planning::RobotAbility ability;
    ability.id = agent;
    ability.start.position = Eigen::Vector2d(-5.0, 3.0 * static_cast<double>(abilities.size()));
    abilities.push_back(ability);
  }
  planning::MissionConfig config;
  config.rendezvous = false;
  config.division.search_rounds = 2;
  auto plan = planning::plan_fleet(std::move(mission), abilities, config);
  if (!plan) throw std::logic_error(plan.error().message);
  return *plan;
}

/// The point `along` m of the path.
Eigen::Vector2d point_of(const planning::Polyline& path, double along) {
  for (std::size_t k = 1; k < path.size(); ++k) {
    const Eigen::Vector2d step = path[k] - path[k - 1];
    if (along <= step.norm() && step.norm() > 0.0) return path[k - 1] + along / step.norm() * step;
    along -= step.norm();
  }
  return path.back();
}

}  // namespace

SimulatedMission::SimulatedMission(const std::vector<AgentId>& fleet)
    : plan_(plan_of(fleet)), coverage_(plan_->mission), metres_(plan_->mission.rows.size()) {
  for (std::size_t k = 0; k < plan_->fleet.size(); ++k) {
    Robot& robot = robots_[plan_->fleet[k].id];
    robot.index = k;
    robot.pose = plan_->fleet[k].start;
  }
}

void SimulatedMission::start(const AgentId& robot) {
  auto executive = planning::MissionExecutive::create(plan_, robot);
  robots_.at(robot).executive = std::make_unique<planning::MissionExecutive>(std::move(*executive));
  robots_.at(robot).action = {};
}

void SimulatedMission::on_report(const AgentId& robot, const messages::MissionReport& report, Stamp now) {
  if (Robot& listener = robots_.at(robot); listener.executive) listener.executive->on_report(report, now);
}

void SimulatedMission::mark(const Eigen::Vector2d& at) {
  coverage_.add(at);
  for (std::size_t k = 0; k < metres_.size(); ++k) {
    const planning::Polyline& line = plan_->mission.rows[k].waypoints;
    if (std::abs(at.y() - line[0].y()) < 0.5 && at.x() >= 0.0 && at.x() < kRowLength)
      metres_[k].insert(static_cast<int>(at.x()));
  }
}

void SimulatedMission::move(Robot& robot, double metres) {
  const planning::Polyline& path = robot.action.path;
  const double end = std::min(planning::length_of(path), robot.along + metres);
  while (robot.along < end - 1e-9) {
    robot.along = std::min(end, robot.along + kStep);
    const Eigen::Vector2d to = point_of(path, robot.along), way = to - robot.pose.position;
    if (way.norm() > 1e-9) robot.pose.yaw = std::atan2(way.y(), way.x());
    robot.pose.position = to;
    mark(to);
  }
}

void SimulatedMission::drive(const AgentId& name, double seconds, Stamp now) {
  Robot& robot = robots_.at(name);
  const bool follows = robot.action.kind == planning::MissionAction::Kind::kFollow;
  if (follows) move(robot, seconds * plan_->fleet[robot.index].speed);
  planning::MissionInput input;
  input.now = now;
  input.pose = robot.pose;
  input.path_number = robot.action.path_number;
  input.finished = follows && robot.along >= planning::length_of(robot.action.path) - 1e-9;
  input.progress = robot.along;
  input.surveyed = coverage_.covered();
  planning::MissionAction next = robot.executive->update(input);
  if (next.path_number != robot.action.path_number) robot.along = 0.0;
  robot.action = std::move(next);
}

messages::MissionReport SimulatedMission::false_report(const AgentId& robot, Stamp now) const {
  messages::MissionReport report = this->report(robot);
  report.stamp = now;
  for (std::size_t row = 0; row < metres_.size(); ++row) report.done.set(row);
  return report;
}

bool SimulatedMission::is_driven(std::size_t row) const {
  return static_cast<double>(metres_[row].size()) >= kDriven * kRowLength;
}

std::optional<std::size_t> SimulatedMission::skipped_row(const AgentId& robot,
                                                         const std::optional<AgentId>& compromised) const {
  const messages::RowSet done = report(robot).done;
  for (std::size_t k = 0; k < plan_->fleet.size(); ++k) {
    if (plan_->fleet[k].id == compromised) continue;
    for (const planning::RowVisit& visit : plan_->division.routes[k].visits)
      if (done.has(visit.row) && !is_driven(visit.row)) return visit.row;
  }
  return {};
}

}  // namespace fleetmap::fault_injection
