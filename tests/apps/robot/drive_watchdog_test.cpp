#include "apps/robot/drive_watchdog.hpp"

#include <gtest/gtest.h>

#include "apps/driving_twin.hpp"

namespace fleetmap {
namespace {

using namespace std::chrono_literals;
using bus::testing::first_test_domain;

/// A bus on which nothing drives, but for the watchdog.
class DriveWatchdog : public ::testing::Test {
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

  testing::CommandLog log_{"r1", first_test_domain()};
  std::atomic<bool> stop_ = false;
  std::unique_ptr<bus::DdsBus> bus_;
  std::unique_ptr<apps::DriveWatchdog> watchdog_;
};

TEST_F(DriveWatchdog, StopsTheRobotWhileTheProgramIsBusy) {
  EXPECT_EQ(log_.heard_within(50ms), 0u) << "it was not busy yet";
  bus_->post([&] {
    const Stamp event = log_.now();
    log_.hear_for(1s);
    log_.expect_stands_since(event);
    log_.expect_stands_now();
  });
  bus_->run_until([] { return false; }, 100ms);
}

TEST_F(DriveWatchdog, StopsTheRobotWhileTheProgramEnds) {
  stop_ = true;
  log_.expect_stands_now();
}

}  // namespace
}  // namespace fleetmap
