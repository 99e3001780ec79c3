// cmd_vel of real processes over DDS: `fleetmap sim`, whose chassis obey the last command for ever, an agent
// or two, and the operator's commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "apps/drive_watchdog.hpp"
#include "apps/small_twin.hpp"
#include "bus/dds_domains.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using namespace std::chrono_literals;
using bus::testing::first_test_domain;
using ::testing::HasSubstr;

constexpr Duration kPromise = 300ms;

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
      return since && now() - *since > 1s;
    };
    return bus_->run_until(driving, patience);
  }
  /// Expects zero at most kPromise after `event`, and nothing but zero from then until now.
  void expect_stands_since(Stamp event) const {
    const auto first =
        std::ranges::find_if(commands_, [&](const Command& c) { return c.at > event && c.zero; });
    ASSERT_NE(first, commands_.end()) << name_ << " was never told to stand";
    EXPECT_LE(to_seconds(first->at - event), to_seconds(kPromise)) << name_;
    const auto moving = std::find_if(first, commands_.end(), [](const Command& c) { return !c.zero; });
    if (moving == commands_.end()) return;
    EXPECT_LE(to_seconds(moving->at - event), to_seconds(kPromise)) << name_ << " drove on";
    EXPECT_TRUE(std::all_of(moving + 1, commands_.end(),
                            [&](const Command& c) { return c.zero || c.at - event <= kPromise; }))
        << name_ << " drove on";
  }
  /// Expects that no message within two seconds moves the robot.
  void expect_stands_now() {
    hear_for(200ms);  // what waits
    commands_.clear();
    hear_for(2s);
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

class DriveStop : public ::testing::Test {
 protected:
  void SetUp() override {
    twin_.write("two.yaml",
                "world: {file: world.yaml}\nsite: {origin: [39.0, -3.0, 600.0]}\n"
                "mission: {every: 1, rendezvous: false, speed: 0.5}\n"
                "dds: {base_domain: " +
                    std::to_string(first_test_domain()) + ", qos: " + FLEETMAP_SOURCE_DIR +
                    "/qos}\n"
                    "defaults:\n"
                    "  lidar: {translation: [0, 0, 0.6], max_range: 40, min_range: 0.6}\n"
                    "  imu: {translation: [0, 0, 0.1]}\n"
                    "  gps: {translation: [-0.2, 0, 0.5]}\n"
                    "  robot: {lidar: lidar.yaml, vehicle: {command_timeout: 0}}\n"
                    "agents: [{id: r1}, {id: r2}]\n");
  }
  std::string file() const { return twin_.path("two.yaml").string(); }
  std::unique_ptr<testing::Process> start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), testing::kProgram);
    return std::make_unique<testing::Process>(arguments);
  }
  std::unique_ptr<testing::Process> sim() const { return start({"sim", "-c", file()}); }
  std::unique_ptr<testing::Process> agent(const std::string& id) const {
    return start({"agent", "-c", file(), "--as", id, "--out", twin_.path("out").string()});
  }
  CommandLog log(int robot) const {
    return CommandLog("r" + std::to_string(robot),
                      first_test_domain() + 1 + static_cast<std::uint32_t>(robot));
  }

  testing::SmallTwin twin_;
};

TEST_F(DriveStop, WhenTheProcessIsToldToStop) {
  CommandLog r1 = log(1);
  const auto twin = sim();
  const auto process = agent("r1");
  ASSERT_TRUE(r1.hear_until_driving(60s)) << process->output() << twin->output();
  const Stamp event = r1.now();
  process->signal(SIGTERM);
  r1.hear_for(4s);
  r1.expect_stands_since(event);
  EXPECT_EQ(process->wait(), 0) << process->output();
}

TEST_F(DriveStop, WhenTheSensorsDie) {
  CommandLog r1 = log(1);
  const auto twin = sim();
  const auto process = agent("r1");
  ASSERT_TRUE(r1.hear_until_driving(60s)) << process->output() << twin->output();
  const Stamp event = r1.now();
  twin->signal(SIGKILL);
  r1.hear_for(3s);
  r1.expect_stands_since(event);
  EXPECT_THAT(process->output(), HasSubstr("r1: stands still: no scan comes"));
}

TEST_F(DriveStop, WhenTheOperatorSaysSo) {
  CommandLog r1 = log(1), r2 = log(2);
  const auto twin = sim();
  const auto first = agent("r1"), second = agent("r2");
  ASSERT_TRUE(r1.hear_until_driving(60s)) << first->output() << twin->output();
  const auto order = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, {"-c", file(), "--timeout", "20"});
    const auto command = start(arguments);
    const int code = command->wait();
    EXPECT_EQ(code, 0) << command->output();
    return command->output();
  };
  const std::string held = order({"hold"});
  EXPECT_THAT(held, HasSubstr("r1 stands"));
  EXPECT_THAT(held, HasSubstr("r2 stands"));
  r1.expect_stands_now();
  r2.expect_stands_now();

  EXPECT_THAT(order({"resume", "--robot", "r1"}), HasSubstr("r1 drives on"));
  EXPECT_TRUE(r1.hear_until_driving(30s)) << first->output();
  r2.expect_stands_now();

  second->signal(SIGTERM);
  second->wait();
  const auto unheard = start({"hold", "-c", file(), "--timeout", "4"});
  EXPECT_EQ(unheard->wait(), 1);
  EXPECT_THAT(unheard->output(), HasSubstr("r1 stands"));
  EXPECT_THAT(unheard->output(), HasSubstr("r2 did not confirm"));
}

/// A bus on which nothing drives, but for the watchdog.
class Watchdog : public ::testing::Test {
 protected:
  void SetUp() override {
    bus::DdsBusConfig config;
    config.agent = AgentId::parse("r1").value();
    config.qos_directory = std::string(FLEETMAP_SOURCE_DIR) + "/qos";
    config.onboard.domain = first_test_domain();
    config.long_range.enabled = config.short_range.enabled = false;
    bus_ = bus::DdsBus::create(config).value();
    watchdog_ = std::make_unique<apps::DriveWatchdog>(*bus_, stop_);
    const auto matched = [&] { return bus_->matches(ros_codec::topics::cmd_vel()).readers == 1; };
    ASSERT_TRUE(bus_->run_until(matched, 20s));
    bus_->run_until([] { return false; }, 300ms);
  }

  CommandLog log_{"r1", first_test_domain()};
  std::atomic<bool> stop_ = false;
  std::unique_ptr<bus::DdsBus> bus_;
  std::unique_ptr<apps::DriveWatchdog> watchdog_;
};

TEST_F(Watchdog, StopsTheRobotWhileTheProgramIsBusy) {
  EXPECT_EQ(log_.heard_within(50ms), 0u) << "it was not busy yet";
  bus_->post([&] {
    const Stamp event = log_.now();
    log_.hear_for(1s);
    log_.expect_stands_since(event);
    log_.expect_stands_now();
  });
  bus_->run_until([] { return false; }, 100ms);
}

TEST_F(Watchdog, StopsTheRobotWhileTheProgramEnds) {
  stop_ = true;
  log_.expect_stands_now();
}

TEST_F(DriveStop, OrdersThatCannotBeGivenAreRefused) {
  const auto unknown = start({"hold", "-c", file(), "--robot", "r9"});
  EXPECT_EQ(unknown->wait(), 2);
  EXPECT_THAT(unknown->output(), HasSubstr("has no robot 'r9'"));
  const auto world = start({"resume", "-c", twin_.path("world.yaml").string()});
  EXPECT_EQ(world->wait(), 78);
  EXPECT_THAT(world->output(), HasSubstr("no robot's and no fleet's"));
}

}  // namespace
}  // namespace fleetmap
