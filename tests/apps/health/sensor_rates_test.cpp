#include "health/sensor_rates.hpp"

#include <gtest/gtest.h>

#include "agent/lapping_robot.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

TEST(SensorRates, CountTheSamplesSinceTheLastCall) {
  const testing::TemporaryFolder folder;
  testing::LappingRobot::Options options;
  options.columns = 200;
  options.fitted[static_cast<std::size_t>(sensor::Source::kGps)] = false;
  options.folder = folder.path() / "r1";
  testing::LappingRobot robot(options);
  SensorRates rates;
  for (const monitor::SensorNow& sensor : rates.add(robot.agent().perception(), robot.bus().now()))
    EXPECT_EQ(sensor.per_second, 0.0) << sensor.name;
  robot.run_for(4.0);
  const auto now = rates.add(robot.agent().perception(), robot.bus().now());
  ASSERT_EQ(now.size(), sensor::kSources);
  EXPECT_NEAR(now[0].per_second, options.scan_rate, 0.5);
  EXPECT_NEAR(static_cast<double>(now[0].samples), 4.0 * options.scan_rate, 2.0);
  EXPECT_GT(now[1].per_second, 10.0) << "an IMU";
  EXPECT_EQ(now[2].per_second, 0.0) << "no GPS";
  EXPECT_EQ(now[0].silent_s, 0.0);
  EXPECT_NEAR(rates.add(robot.agent().perception(), robot.bus().now() + std::chrono::seconds(7))[0].silent_s,
              7.0, 1e-9);
  const auto at_once = rates.add(robot.agent().perception(), robot.bus().now());
  EXPECT_EQ(at_once[0].per_second, 0.0) << "no time has passed";
}

}  // namespace
}  // namespace fleetmap::apps
