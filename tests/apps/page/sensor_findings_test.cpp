#include "page/sensor_findings.hpp"

#include <gmock/gmock.h>

#include "agent/lapping_robot.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::IsEmpty;
using ::testing::MatchesRegex;

constexpr auto kImu = static_cast<std::size_t>(sensor::Source::kImu);

class SensorFindingsTest : public ::testing::Test {
 protected:
  SensorFindingsTest() {
    options_.columns = 200;
    options_.folder = folder_.path() / "r1";
  }
  std::vector<SensorFinding> found(testing::LappingRobot& robot) const {
    return sensor_findings(robot.agent().perception(), robot.bus().now());
  }
  const SensorFinding* of_imu(const std::vector<SensorFinding>& all) const {
    const auto one = std::ranges::find(all, std::optional(sensor::Source::kImu), &SensorFinding::source);
    return one == all.end() ? nullptr : &*one;
  }

  const testing::TemporaryFolder folder_;
  testing::LappingRobot::Options options_;
};

TEST_F(SensorFindingsTest, ThereIsNoneOfASoundRobot) {
  testing::LappingRobot robot(options_);
  robot.run_for(3.0);
  EXPECT_THAT(found(robot), IsEmpty());
}

TEST_F(SensorFindingsTest, AClockThatIsOffIsAFindingOfItsSensorWithoutTheRemedy) {
  options_.clocks[kImu].ahead = -std::chrono::seconds(5);
  testing::LappingRobot robot(options_);
  robot.run_for(20.0);
  const auto all = found(robot);
  const SensorFinding* finding = of_imu(all);
  ASSERT_NE(finding, nullptr);
  EXPECT_THAT(finding->text, MatchesRegex("imu: stamps are .* s behind those of the other sensors"));
  EXPECT_FALSE(finding->is_over);
  robot.set_clock(sensor::Source::kImu, {});
  robot.run_for(60.0);
  const auto later = found(robot);
  ASSERT_NE(of_imu(later), nullptr);
  EXPECT_TRUE(of_imu(later)->is_over) << "the clock was set";
}

TEST_F(SensorFindingsTest, ASilenceIsOverOnceTheSensorSendsAgain) {
  testing::LappingRobot robot(options_);
  robot.run_for(20.0);
  robot.set_fitted(sensor::Source::kGps, false);
  robot.run_for(100.0);
  const auto no_fix = [&] {
    const auto all = found(robot);
    const auto one = std::ranges::find(all, std::optional(sensor::Source::kGps), &SensorFinding::source);
    return one == all.end() ? std::optional<SensorFinding>() : *one;
  };
  ASSERT_TRUE(no_fix());
  EXPECT_THAT(no_fix()->text, ::testing::HasSubstr("GPS: no fix since"));
  EXPECT_FALSE(no_fix()->is_over);
  robot.set_fitted(sensor::Source::kGps, true);
  robot.run_for(3.0);
  ASSERT_TRUE(no_fix());
  EXPECT_TRUE(no_fix()->is_over);
}

}  // namespace
}  // namespace fleetmap::apps
