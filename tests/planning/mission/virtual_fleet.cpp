#include "planning/mission/virtual_fleet.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planning/sites.hpp"

namespace fleetmap::planning::testing {

VirtualFleet::VirtualFleet(std::shared_ptr<const FleetPlan> shared, double loss, std::uint64_t seed)
    : plan(std::move(shared)), loss_(loss), random_(seed), coverage_(plan->mission) {
  for (const RobotAbility& ability : plan->fleet) {
    Robot robot;
    robot.pose = ability.start;
    robot.speed = ability.speed;
    robots.push_back(std::move(robot));
    start(robots.size() - 1);
  }
}

void VirtualFleet::start(std::size_t k) {
  robots[k].executive =
      std::make_unique<MissionExecutive>(*MissionExecutive::create(plan, plan->fleet[k].id));
  robots[k].action = {};
  robots[k].along = 0.0;
}

void VirtualFleet::give(RowId row, std::size_t from, std::optional<std::size_t> to) {
  orders_.push_back({stamp(), plan->fleet[from].id, to ? plan->fleet[*to].id : AgentId{}, {}, row});
  for (Robot& robot : robots) {
    if (robot.executive) robot.executive->set_row_orders(orders_);
  }
}

double VirtualFleet::driven_by(std::size_t k, RowId row) const {
  const auto found = visited_by_.find({k, row});
  return found == visited_by_.end() ? 0.0 : static_cast<double>(found->second.size());
}

Stamp VirtualFleet::stamp() const { return stamp_from_ns(static_cast<std::int64_t>(now * 1e9)); }

void VirtualFleet::step() {
  exchange();
  for (std::size_t k = 0; k < robots.size(); ++k) {
    Robot& robot = robots[k];
    if (!robot.executive) continue;
    const bool following = robot.action.kind == MissionAction::Kind::kFollow;
    MissionInput input{stamp(), robot.pose, robot.battery, robot.action.path_number};
    input.finished = following && robot.along >= length_of(robot.action.path) - 1e-6;
    input.stuck = following && robot.standing > 15.0;
    input.progress = robot.along;
    input.maps_exchanged = robot.exchanged;
    input.called_home = robot.called_home;
    input.surveyed = coverage_.covered();
    if (radio) {
      for (const std::size_t other : radio->even_with(k)) {
        input.exchanged_with.push_back(plan->fleet[other].id);
      }
    }
    const std::uint64_t before = robot.action.path_number;
    robot.action = robot.executive->update(input);
    if (robot.action.path_number != before) robot.along = robot.standing = 0.0;
    robot.state = robot.executive->report().state;
    if (robot.action.kind == MissionAction::Kind::kFollow) move(robot);
  }
  report();
  now += 1.0;
}

double VirtualFleet::run(double limit, const std::function<void()>& each) {
  while (now < limit) {
    each();
    step();
    bool all = true;
    for (const Robot& robot : robots) all &= !robot.executive || robot.state == MissionState::kDone;
    if (all) break;
  }
  return now;
}

std::size_t VirtualFleet::rows_driven() const {
  std::size_t count = 0;
  for (const Row& row : plan->mission.rows) {
    const auto found = visited_.find(row.id);
    const auto whole = static_cast<std::size_t>(std::ceil(length_of(row.waypoints)));
    count += found != visited_.end() && found->second.size() + 4 >= whole ? 1 : 0;
  }
  return count;
}

void VirtualFleet::move(Robot& robot) {
  const Polyline& path = robot.action.path;
  const double length = length_of(path);
  const double to = std::min(length, robot.along + robot.speed);
  bool moved = false;
  while (robot.along < to - 1e-9) {
    const double next = std::min(to, robot.along + 0.5);
    const Eigen::Vector2d p = point(path, next);
    bool blocked = false;
    for (const Obstacle& o : obstacles) {
      blocked |= (p - o.at).norm() < o.radius && (p - o.at).norm() < (robot.pose.position - o.at).norm();
    }
    if (blocked) break;
    const Eigen::Vector2d d = p - robot.pose.position;
    if (d.norm() > 1e-9) robot.pose.yaw = std::atan2(d.y(), d.x());
    robot.driven += d.norm();
    robot.pose.position = p;
    robot.along = next;
    moved = true;
    mark(robot);
  }
  robot.standing = moved ? 0.0 : robot.standing + 1.0;
  robot.battery -= robot.drain;
}

Eigen::Vector2d VirtualFleet::point(const Polyline& path, double along) {
  for (std::size_t k = 1; k < path.size(); ++k) {
    const double step = (path[k] - path[k - 1]).norm();
    if (along <= step && step > 0.0) return path[k - 1] + (path[k] - path[k - 1]) * along / step;
    along -= step;
  }
  return path.back();
}

void VirtualFleet::mark(const Robot& robot) {
  const Eigen::Vector2d& p = robot.pose.position;
  const auto k = static_cast<std::size_t>(&robot - robots.data());
  coverage_.add(p);
  for (const Row& row : plan->mission.rows) {
    const Eigen::Vector2d d = row.waypoints.back() - row.waypoints.front();
    const double on = (p - row.waypoints.front()).dot(d.normalized());
    const double beside =
        std::abs((p - row.waypoints.front()).dot(Eigen::Vector2d(-d.y(), d.x()).normalized()));
    if (!(beside < 0.5 && on > -0.1 && on < d.norm() + 0.1)) continue;
    visited_[row.id].insert(static_cast<int>(on));
    visited_by_[{k, row.id}].insert(static_cast<int>(on));
  }
}

void VirtualFleet::report() {
  for (std::size_t k = 0; k < robots.size(); ++k) {
    // Every 5 s, each at its own time.
    if (!robots[k].executive || static_cast<int>(now) % 5 != static_cast<int>(k % 5)) continue;
    if (silent(k, now)) continue;
    for (std::size_t other = 0; other < robots.size(); ++other) {
      if (other == k || !robots[other].executive || silent(other, now)) continue;
      if (uniform(random_) < loss_) continue;
      robots[other].executive->on_report(robots[k].executive->report(), stamp());
    }
  }
}

void VirtualFleet::exchange() {
  if (radio) return exchange_by_radio();
  bool all = true;
  for (const Robot& robot : robots) {
    all &= !robot.executive || robot.state == MissionState::kMeeting || robot.state == MissionState::kDone ||
           robot.state == MissionState::kStuck || robot.state == MissionState::kLowBattery ||
           robot.state == MissionState::kCalledHome;
  }
  for (Robot& robot : robots) robot.exchanged |= all && robot.state == MissionState::kMeeting;
}

void VirtualFleet::exchange_by_radio() {
  std::vector<MapRadio::Robot> on_air;
  for (const Robot& robot : robots) {
    on_air.push_back({robot.pose.position, robot.driven, robot.executive != nullptr});
  }
  radio->step(on_air, 1.0);
  for (std::size_t k = 0; k < robots.size(); ++k) robots[k].exchanged = radio->all_hold_all();
}

}  // namespace fleetmap::planning::testing
