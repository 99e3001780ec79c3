#include "health/live_odometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "apps/made_robot.hpp"
#include "fleetmap/bus/local_network.hpp"

namespace fleetmap::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A computer that takes `scan_time` for a scan.
class Computer {
 public:
  explicit Computer(Duration scan_time) {
    config_.odometry.T_base_lidar = testing::ScanOptions{}.T_base_lidar;
    bus::LocalNetworkConfig network;
    network.start = kStart;
    network.perception_time = scan_time;
    network_ = bus::LocalNetwork::create(network).value();
    check_ = std::make_unique<SampleCheck>(recording::LogClock{}, config_);
    odometry_ =
        std::make_unique<LiveOdometry>(config_, network_->add_robot(AgentId::parse("r1").value()), *check_);
  }
  /// Returns what is found.
  std::vector<std::string> hear(std::vector<SentSample> samples) {
    for (SentSample& sent : samples) {
      network_->run_until(sent.sent);
      if (check_->admit(sent.sample, sent.sent)) odometry_->add(std::move(sent.sample));
    }
    network_->run_until(network_->now() + 10s);
    EXPECT_TRUE(odometry_->idle());
    return check_->take_warnings();
  }
  const LiveOdometry& odometry() const { return *odometry_; }

 private:
  agent::PerceptionConfig config_;
  std::unique_ptr<bus::LocalNetwork> network_;
  std::unique_ptr<SampleCheck> check_;
  std::unique_ptr<LiveOdometry> odometry_;
};

std::vector<SentSample> in_km_h(std::vector<SentSample> samples) {
  for (SentSample& sent : samples) {
    if (auto* wheel = std::get_if<sensor::Wheel>(&sent.sample)) wheel->forward_speed *= 3.6;
  }
  return samples;
}

TEST(LiveOdometry, ComparesTheWheelsWithTheScans) {
  Computer computer(30ms);
  EXPECT_THAT(computer.hear(in_km_h(samples_of_a_robot(1.5, 10.0, kStart))), Contains(HasSubstr("km/h")));
  EXPECT_THAT(computer.odometry().failures(), IsEmpty());
}

TEST(LiveOdometry, OfARobotThatStandsItSaysThatNothingWasCompared) {
  Computer computer(30ms);
  EXPECT_THAT(computer.hear(samples_of_a_robot(0.0, 5.0, kStart)), IsEmpty());
  EXPECT_THAT(computer.odometry().notes(),
              ElementsAre(HasSubstr("motions not compared: the speed of the wheels, turns, stamps: by the "
                                    "LiDAR the robot drove 0 m and turned by 0 deg")));
}

TEST(LiveOdometry, ASlowComputerLeavesScansOutAndComparesTheRest) {
  Computer computer(250ms);
  EXPECT_THAT(computer.hear(in_km_h(samples_of_a_robot(1.5, 12.0, kStart))), Contains(HasSubstr("km/h")));
  EXPECT_THAT(computer.odometry().notes(), Contains(HasSubstr(" of 119 scans came faster than")));
}

TEST(LiveOdometry, WithoutScansThereIsNothingToSay) {
  Computer computer(30ms);
  std::vector<SentSample> samples = samples_of_a_robot(0.0, 1.0, kStart);
  std::erase_if(samples,
                [](const SentSample& sent) { return std::holds_alternative<sensor::Scan>(sent.sample); });
  EXPECT_THAT(computer.hear(samples), IsEmpty());
  EXPECT_THAT(computer.odometry().notes(), IsEmpty());
  EXPECT_THAT(computer.odometry().failures(), IsEmpty());
}

}  // namespace
}  // namespace fleetmap::apps
