#include "fleetmap/ros_output/diagnostics.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace fleetmap::ros_output {
namespace {

using ros_codec::DiagnosticsMsg;
using Level = DiagnosticsMsg::Level;

const AgentId kSelf = AgentId::parse("r1").value(), kOther = AgentId::parse("r2").value();

DiagnosticsMsg::Item item(const RobotState& state, const std::string& name) {
  const DiagnosticsMsg message = diagnostics(state);
  const auto found = std::ranges::find(message.items, name, &DiagnosticsMsg::Item::name);
  if (found != message.items.end()) return *found;
  ADD_FAILURE() << "no " << name;
  return {};
}
std::string value(const DiagnosticsMsg::Item& item, const std::string& key) {
  for (const auto& [name, text] : item.values)
    if (name == key) return text;
  return "none";
}

TEST(Diagnostics, FindingsOfTheSensorsAreAWarningWithAllOfThem) {
  RobotState state{kSelf, stamp_from_ns(7), {}, {}, {}, {}, {}};
  EXPECT_EQ(diagnostics(state).stamp, stamp_from_ns(7));
  EXPECT_EQ(item(state, "fleetmap: sensor health").level, Level::ok);
  state.findings = {"the IMU reports g", "the gyro reports deg/s"};
  const auto health = item(state, "fleetmap: sensor health");
  EXPECT_EQ(health.level, Level::warning);
  EXPECT_EQ(value(health, "finding 1"), "the IMU reports g");
  EXPECT_EQ(value(health, "finding 2"), "the gyro reports deg/s");
}

TEST(Diagnostics, ANoteIsThereAndNoWarning) {
  RobotState state{kSelf, {}, {}, {}, {}, {}, {"imu: stamps are 37.00 s ahead and corrected"}};
  const auto health = item(state, "fleetmap: sensor health");
  EXPECT_EQ(health.level, Level::ok);
  EXPECT_EQ(health.message, "no finding");
  EXPECT_EQ(value(health, "note 1"), "imu: stamps are 37.00 s ahead and corrected");
}

TEST(Diagnostics, ASensorIsStaleByTheAgeOfItsLastSample) {
  RobotState state{kSelf, {}, {}, {}, {}, {}, {}};
  state.sensors = {{"LiDAR", 20, 10.0, 0.25, {}, 0.0},
                   {"IMU", 5, 0.0, {}, {}, 6.0},
                   {"GPS", 4, 0.0, {}, {}, 2.0},
                   {"wheels", 0, 0.0, {}, {}, 0.0}};
  EXPECT_EQ(item(state, "fleetmap: LiDAR").level, Level::ok);
  EXPECT_EQ(item(state, "fleetmap: LiDAR").message, "10.0 Hz");
  EXPECT_EQ(value(item(state, "fleetmap: LiDAR"), "clock behind, s"), "0.250");
  EXPECT_EQ(item(state, "fleetmap: IMU").level, Level::stale);
  EXPECT_EQ(item(state, "fleetmap: IMU").message, "last sample 6 s ago");
  EXPECT_EQ(item(state, "fleetmap: GPS").level, Level::ok) << "its rate is below 1 Hz";
  for (const auto& one : diagnostics(state).items) EXPECT_NE(one.name, "fleetmap: wheels") << "never heard";
}

TEST(Diagnostics, ARobotIsAWarningWithAProblemAndStaleUnheard) {
  monitor::RobotNow self, other;
  self.id = kSelf;
  self.activity = "maps";
  self.battery = 0.5;
  other.id = kOther;
  other.activity = "was not heard yet";
  RobotState state{kSelf, {}, {}, {}, {self, other}, 60.0, {}};
  EXPECT_EQ(item(state, "fleetmap: robot r1").level, Level::ok) << "it does not hear itself";
  EXPECT_EQ(item(state, "fleetmap: robot r1").message, "maps");
  EXPECT_EQ(value(item(state, "fleetmap: robot r1"), "battery, %"), "50");
  EXPECT_EQ(item(state, "fleetmap: robot r2").level, Level::stale);
  state.robots[1].heard = {{"long_range", 2.0}};
  state.robots[1].problems = {"no scan for 9 s"};
  EXPECT_EQ(item(state, "fleetmap: robot r2").level, Level::warning);
  EXPECT_EQ(item(state, "fleetmap: robot r2").message, "no scan for 9 s");
  EXPECT_EQ(value(item(state, "fleetmap: robot r2"), "heard on long_range"), "2.0 s ago");
}

TEST(Diagnostics, ARobotIsStaleWhenItWasHeardForTheLastTimeLongAgo) {
  monitor::RobotNow other;
  other.id = kOther;
  other.heard = {{"short_range", 300.0}, {"long_range", 59.0}};
  RobotState state{kSelf, {}, {}, {}, {other}, 60.0, {}};
  EXPECT_EQ(item(state, "fleetmap: robot r2").level, Level::ok) << "by the link that heard it last";
  state.robots[0].heard[1].seconds_ago = 61.0;
  EXPECT_EQ(item(state, "fleetmap: robot r2").level, Level::stale);
  state.robots[0].problems = {"no scan for 9 s"};
  EXPECT_EQ(item(state, "fleetmap: robot r2").level, Level::stale) << "what it said is old";
  state.lost_after_s.reset();
  state.robots[0] = {};
  state.robots[0].id = kOther;
  EXPECT_EQ(item(state, "fleetmap: robot r2").level, Level::ok) << "hearing is not known";
}

}  // namespace
}  // namespace fleetmap::ros_output
