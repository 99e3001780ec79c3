#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/small_twin.hpp"
#include "bus/dds_domains.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"

namespace fleetmap::testing {

/// From an event until the robot is told to stand.
constexpr Duration kStandsWithin = std::chrono::milliseconds(300);

/// Hears one robot's cmd_vel.
class CommandLog {
 public:
  struct Command {
    Stamp at;
    bool zero;
  };
  CommandLog(const std::string& robot, std::uint32_t domain) {
    bus::DdsBusConfig config;
    config.agent = AgentId::parse("test").value();
    config.qos_directory = std::string(FLEETMAP_SOURCE_DIR) + "/qos";
    config.onboard.domain = domain;
    config.long_range.enabled = config.short_range.enabled = false;
    bus_ = bus::DdsBus::create(config).value();
    subscription_ = bus_->subscribe(ros_codec::topics::cmd_vel(), [this](const Bytes& cdr) {
      const auto command = ros_codec::decode<ros_codec::VelocityCommand>(cdr).value();
      commands_.push_back({bus_->now(), command.forward_speed == 0.0 && command.yaw_rate == 0.0});
    });
    name_ = robot;
  }
  Stamp now() const { return bus_->now(); }
  void hear_for(Duration time) {
    bus_->run_until([] { return false; }, time);
  }
  /// The robot was commanded to move throughout the last second.
  bool hear_until_driving(Duration patience) {
    std::optional<Stamp> since;
    const auto driving = [&] {
      if (commands_.empty() || commands_.back().zero)
        since.reset();
      else if (!since)
        since = now();
      return since && now() - *since > std::chrono::seconds(1);
    };
    return bus_->run_until(driving, patience);
  }
  /// Expects zero at most kStandsWithin after `event`, and nothing but zero from then until now.
  void expect_stands_since(Stamp event) const {
    const auto first =
        std::ranges::find_if(commands_, [&](const Command& c) { return c.at > event && c.zero; });
    ASSERT_NE(first, commands_.end()) << name_ << " was never told to stand";
    EXPECT_LE(to_seconds(first->at - event), to_seconds(kStandsWithin)) << name_;
    const auto moving = std::find_if(first, commands_.end(), [](const Command& c) { return !c.zero; });
    if (moving == commands_.end()) return;
    EXPECT_LE(to_seconds(moving->at - event), to_seconds(kStandsWithin)) << name_ << " drove on";
    EXPECT_TRUE(std::all_of(moving + 1, commands_.end(),
                            [&](const Command& c) { return c.zero || c.at - event <= kStandsWithin; }))
        << name_ << " drove on";
  }
  /// Expects that no message within two seconds moves the robot.
  void expect_stands_now() {
    hear_for(std::chrono::milliseconds(200));  // what waits
    commands_.clear();
    hear_for(std::chrono::seconds(2));
    EXPECT_GT(commands_.size(), 20u) << name_;
    EXPECT_TRUE(std::ranges::all_of(commands_, &Command::zero)) << name_;
  }
  std::size_t heard_within(Duration time) {
    const std::size_t before = commands_.size();
    hear_for(time);
    return commands_.size() - before;
  }

 private:
  std::string name_;
  std::unique_ptr<bus::DdsBus> bus_;
  std::vector<Command> commands_;
  bus::Handle subscription_;
};

/// `fleetmap sim` of two robots whose chassis obey the last command for ever, and its agents.
class DrivingTwin : public ::testing::Test {
 protected:
  void SetUp() override {
    twin_.write("two.yaml",
                "world: {file: world.yaml}\nsite: {origin: [39.0, -3.0, 600.0]}\n"
                "mission: {every: 1, rendezvous: false, speed: 0.5}\n"
                "dds: {base_domain: " +
                    std::to_string(bus::testing::first_test_domain()) + ", qos: " + FLEETMAP_SOURCE_DIR +
                    "/qos}\n"
                    "defaults:\n"
                    "  lidar: {translation: [0, 0, 0.6], max_range: 40, min_range: 0.6}\n"
                    "  imu: {translation: [0, 0, 0.1]}\n"
                    "  gps: {translation: [-0.2, 0, 0.5]}\n"
                    "  robot: {lidar: lidar.yaml, vehicle: {command_timeout: 0}}\n"
                    "agents: [{id: r1}, {id: r2}]\n");
  }
  std::string file() const { return twin_.path("two.yaml").string(); }
  std::unique_ptr<Process> start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), kProgram);
    return std::make_unique<Process>(arguments);
  }
  std::unique_ptr<Process> sim() const { return start({"sim", "-c", file()}); }
  std::unique_ptr<Process> agent(const std::string& id) const {
    return start({"agent", "-c", file(), "--as", id, "--out", twin_.path("out").string()});
  }
  CommandLog log(int robot) const {
    return CommandLog("r" + std::to_string(robot),
                      bus::testing::first_test_domain() + 1 + static_cast<std::uint32_t>(robot));
  }

  SmallTwin twin_;
};

}  // namespace fleetmap::testing
