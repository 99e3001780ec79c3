#include "live_robot.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <type_traits>
#include <utility>
#include <variant>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "live_bus.hpp"
#include "recordings/sample_player.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kTwinTick = std::chrono::milliseconds(20);
constexpr Duration kBatteryPeriod = std::chrono::seconds(1);
constexpr Duration kTooLate = std::chrono::milliseconds(500);

}  // namespace

Result<std::unique_ptr<LiveRobot>> LiveRobot::create(const config::FleetConfig::Member& member,
                                                     const TwinSetup& setup,
                                                     std::shared_ptr<const sim::Scene> scene) {
  bus::DdsBusConfig dds = member.dds;
  // It stands for sensors and chassis: the radios are the agent's.
  dds.long_range.enabled = false;
  dds.short_range.enabled = false;
  auto bus = join_dds(dds);
  if (!bus) return tl::unexpected(bus.error());
  auto twin = sim::RobotTwin::create(setup.world, setup.origin, member.robot, (*bus)->now());
  if (!twin) return failure("agent " + member.agent.id.str() + ": " + twin.error().message);
  return std::unique_ptr<LiveRobot>(
      new LiveRobot(member, setup.origin, std::move(*bus), std::move(*twin), std::move(scene)));
}

void LiveRobot::start() {
  thread_ = std::thread([this] { bus_->run_until(stop_); });
}

void LiveRobot::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  bus_->finish_work();
}

LiveRobot::LiveRobot(const config::FleetConfig::Member& member, const GeoPoint& origin,
                     std::unique_ptr<bus::DdsBus> bus, sim::RobotTwin twin,
                     std::shared_ptr<const sim::Scene> scene)
    : name_(member.agent.id.str()),
      names_(member.agent.perception.topics),
      site_(origin),
      bus_(std::move(bus)),
      twin_(std::move(twin)),
      scene_(std::move(scene)) {
  for (const bus::Topic& topic : sensor_topics(names_)) bus_->advertise(topic);
  bus_->advertise(ros_codec::topics::battery());
  handles_.push_back(bus_->subscribe(ros_codec::topics::cmd_vel(), [this](const Bytes& cdr) {
    if (const auto command = ros_codec::decode<ros_codec::VelocityCommand>(cdr))
      twin_.command(command->forward_speed, command->yaw_rate);
  }));
  if (twin_.config().guided) lead();
  handles_.push_back(bus_->every(kTwinTick, {"twin", [this] { tick(); }}));
  handles_.push_back(bus_->every(kBatteryPeriod, [this] {
    bus_->publish(ros_codec::topics::battery(),
                  ros_codec::encode(sensor::Battery{bus_->now(), battery_share(twin_)}));
  }));
}

void LiveRobot::lead() {
  bus_->advertise(fleet_codec::topics::guide_pose());
  handles_.push_back(bus_->every(kGuidePeriod, [this] {
    bus_->publish(fleet_codec::topics::guide_pose(), fleet_codec::encode(true_pose(twin_, site_)));
  }));
}

void LiveRobot::publish(const recording::Sample& sample) {
  const EncodedSample encoded = encode(sample, names_);
  bus_->publish(encoded.topic, encoded.cdr);
}

void LiveRobot::tick() {
  const Stamp now = bus_->now();
  if (now - twin_.now() > kTooLate && !std::exchange(late_, true)) {
    spdlog::warn("{}: the twin cannot keep real time on this machine; use fewer robots or lidar_rate 5",
                 name_);
  }
  for (sim::TwinSample& sample : twin_.advance(now)) {
    std::visit(
        [this](auto& s) {
          if constexpr (std::is_same_v<std::decay_t<decltype(s)>, sim::ScanJob>) {
            cast(std::move(s));
          } else {
            publish(s);
          }
        },
        sample);
  }
  truth_.follow(twin_);
}

void LiveRobot::cast(sim::ScanJob job) {
  auto scan = std::make_shared<sensor::Scan>();
  bus_->offload(
      bus::Lane::kPerception,
      [this, scan, job = std::move(job)] { *scan = sim::cast_scan(*scene_, twin_.config().lidar, job); },
      [this, scan] { publish(*scan); });
}

}  // namespace fleetmap::apps
