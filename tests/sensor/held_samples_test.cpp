#include <gmock/gmock.h>

#include "fleetmap/sensor/sensor_health.hpp"
#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(SensorHealth, HeightsAboveSeaLevelAreNamedOnce) {
  SensorHealth health;
  Fix fix{.stamp = at(0.0), .position = {0.7, -0.1, 600.0}};
  EXPECT_TRUE(health.check(fix));
  EXPECT_FALSE(health.heights_above_sea_level());
  fix.above_sea_level = true;
  EXPECT_TRUE(health.check(fix));
  EXPECT_TRUE(health.check(fix));
  EXPECT_TRUE(health.heights_above_sea_level());
  EXPECT_THAT(health.take_warnings(),
              ElementsAre(AllOf(HasSubstr("mean sea level"), HasSubstr("gps.geoid"))));
}

TEST(SensorHealth, ASensorWhoseSamplesAreHeldIsNotSilent) {
  for (const bool held : {true, false}) {
    SensorHealth health;
    for (int k = 0; k < 800; ++k) {
      const Stamp now = at(0.1 * k);
      Pose T_odom_base = Pose::Identity();
      T_odom_base.translation().x() = 0.1 * k;
      health.check_motion(now, T_odom_base);
      Wheel wheel{now, 1.0, 0.0};
      Fix fix{.stamp = now, .position = {0.7, -0.1, 600.0}};
      if (k < 100) {
        health.check(wheel);
        health.check(fix);
      } else if (held) {
        health.hold(wheel);
        health.hold(fix);
      }
    }
    EXPECT_EQ(health.gaps().empty(), held);
  }
}

}  // namespace
}  // namespace fleetmap::sensor
