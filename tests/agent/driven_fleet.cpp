#include "agent/driven_fleet.hpp"

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::testing {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(20);
constexpr Duration kGuidePeriod = std::chrono::milliseconds(100);
const GeoPoint kFarm = geo_point_from_degrees(39.0, -3.0, 600.0);

template <class T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace

DrivenFleet::DrivenFleet(const Options& options) : options_(options), origin_(kFarm) {
  files_.write_fleet("network: {long_range: {loss: " + std::to_string(options.long_range_loss) + "}}\n");
  config_ = must(config::load_fleet(files_.path("fleet.yaml"), {}));
  config_.keep_first(options.robots.size());
  const auto world = must(config::make_world(files_.path("world.yaml")));
  scene_ = must(sim::Scene::create(world->mesh()));

  planning::Mission mission;
  std::vector<planning::RobotAbility> abilities;
  for (std::size_t k = 0; k < options.robots.size(); ++k) {
    const sim::Aisle& lane = world->aisles().at(k);
    const Eigen::Vector2d along = (lane.to - lane.from).normalized();
    mission.rows.push_back({static_cast<planning::RowId>(k), {lane.from, lane.to}});
    sim::RobotTwinConfig& twin = config_.members[k].robot;
    twin.vehicle.command_timeout = 0.0;
    twin.lidar.rate = options.lidar_rate;
    twin.gps.fitted = !options.guided;
    twin.has_start = true;
    twin.start = lane.from;
    twin.start_yaw = std::atan2(along.y(), along.x());
    planning::RobotAbility ability;
    ability.id = config_.members[k].agent.id;
    ability.start = {twin.start, twin.start_yaw};
    abilities.push_back(ability);
  }
  agent::NavigatorConfig navigator;
  navigator.plan = must(planning::plan_fleet(mission, abilities, {}));
  navigator.obstacles.base_height = config_.members[0].robot.vehicle.base_height;

  config_.network.perception_time = options.perception_time;
  config_.network.start = stamp_from_ns(1'700'000'000'000'000'000);
  network_ = must(bus::LocalNetwork::create(config_.network));
  operator_ = &network_->add_robot(robot_id("operator"));
  for (std::size_t k = 0; k < options.robots.size(); ++k) {
    auto& member = config_.members[k];
    member.agent.directory = files_.path(member.agent.id.str());
    member.agent.site_origin = origin_;
    member.agent.store.file_system = options.file_system;
    member.agent.navigator = std::make_shared<const agent::NavigatorConfig>(navigator);
    auto robot = std::make_unique<Robot>();
    robot->id = member.agent.id;
    robot->twin = std::make_unique<sim::RobotTwin>(
        must(sim::RobotTwin::create(world, origin_, member.robot, network_->now())));
    start(*robot);
    robots_.push_back(std::move(robot));
  }
  network_->at(now() + kTick, [this] { tick(); });
}

DrivenFleet::Robot& DrivenFleet::robot(const std::string& name) {
  const auto found = std::ranges::find_if(robots_, [&](const auto& r) { return r->id.str() == name; });
  return **found;
}

void DrivenFleet::start(Robot& robot) {
  const auto member =
      std::ranges::find_if(config_.members, [&](const auto& m) { return m.agent.id == robot.id; });
  robot.bus = &network_->add_robot(robot.id);
  robot.handles.push_back(
      robot.bus->subscribe(ros_codec::topics::cmd_vel(), [this, &robot](const Bytes& cdr) {
        const auto command = ros_codec::decode<ros_codec::VelocityCommand>(cdr).value();
        robot.commands.push_back({now(), command});
        robot.twin->command(command.forward_speed, command.yaw_rate);
      }));
  robot.handles.push_back(robot.bus->subscribe(
      fleet_codec::topics::global_pose(),
      [&robot](const Bytes& cdr) { robot.G = fleet_codec::decode<GlobalPose>(cdr).value(); }));
  robot.agent = must(agent::Agent::create(member->agent, *robot.bus));
}

void DrivenFleet::restart(const std::string& name) {
  Robot& self = robot(name);
  self.handles.clear();
  network_->finish_work(self.id);  // it uses the agent and its store
  self.agent.reset();
  network_->remove_robot(self.id);
  self.twin->command(0.0, 0.0);
  start(self);
}

void DrivenFleet::tick() {
  for (const auto& robot : robots_) {
    sense(*robot);
    if (options_.guided && robot->guide && now() - robot->last_guide >= kGuidePeriod) guide(*robot);
  }
  network_->at(now() + kTick, [this] { tick(); });
}

void DrivenFleet::guide(Robot& robot) {
  robot.last_guide = now();
  GlobalPose pose;
  pose.stamp = now();
  const Pose T = robot.twin->T_enu_base();
  pose.position = LocalFrame(origin_).to_geo(T.translation());
  pose.q_enu_base = Eigen::Quaterniond(T.linear()).normalized();
  robot.bus->publish(fleet_codec::topics::guide_pose(), fleet_codec::encode(pose));
}

void DrivenFleet::sense(Robot& robot) {
  for (sim::TwinSample& sample : robot.twin->advance(now())) {
    if (!std::holds_alternative<sim::ScanJob>(sample)) {
      std::visit(
          [&robot](auto& measured) {
            if constexpr (requires { measured.stamp; }) measured.stamp += robot.clock;
          },
          sample);
    }
    if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
      robot.bus->publish(ros_codec::topics::imu(), ros_codec::encode(*imu));
    } else if (const auto* fix = std::get_if<sensor::Fix>(&sample)) {
      if (robot.fixes) robot.bus->publish(ros_codec::topics::fix(), ros_codec::encode(*fix));
    } else if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) {
      if (robot.wheel) robot.bus->publish(ros_codec::topics::wheel_odometry(), ros_codec::encode(*wheel));
    } else if (robot.scans) {
      sensor::Scan scan = sim::cast_scan(*scene_, robot.twin->config().lidar, std::get<sim::ScanJob>(sample));
      if (!robot.points) scan.points.resize(10);
      scan.stamp += robot.clock + robot.lidar_clock;
      robot.last_scan = now();
      robot.bus->publish(ros_codec::topics::points(), ros_codec::encode(scan));
    }
  }
}

bool DrivenFleet::run_until_driving() {
  for (int k = 0; k < 60; ++k) {
    run_for(std::chrono::milliseconds(500));
    if (std::ranges::all_of(robots_, [](const auto& r) { return r->twin->speed() > 0.5; })) return true;
  }
  return false;
}

messages::HoldOrder DrivenFleet::order_now(const std::string& robot, bool hold) const {
  return {now(), robot.empty() ? AgentId{} : robot_id(robot), robot_id("operator"),
          hold ? messages::HoldOrder::Kind::kHold : messages::HoldOrder::Kind::kResume};
}

void DrivenFleet::send(messages::Hold orders) {
  orders.from = robot_id("operator");
  operator_->publish(fleet_codec::topics::hold(), fleet_codec::encode(orders));
}

void DrivenFleet::order(const std::string& robot, bool hold) { send({{}, {}, {order_now(robot, hold)}}); }

void DrivenFleet::call_home(const std::string& robot) {
  messages::HoldOrder order = order_now(robot, false);
  order.kind = messages::HoldOrder::Kind::kHome;
  send({{}, {}, {order}});
}

void DrivenFleet::give(const std::string& robot, std::uint32_t row, const std::string& to) {
  const AgentId receiver = to.empty() ? AgentId{} : robot_id(to);
  send({{}, {}, {}, {{now(), robot_id(robot), receiver, robot_id("operator"), row}}});
}

Stamp stands_from(const DrivenFleet::Robot& robot, Stamp event, Stamp until) {
  Stamp from = until + Duration(1);
  for (auto command = robot.commands.rbegin(); command != robot.commands.rend(); ++command) {
    if (command->at > until) continue;
    if (command->at < event || !command->zero()) break;
    from = command->at;
  }
  return from;
}

}  // namespace fleetmap::testing
