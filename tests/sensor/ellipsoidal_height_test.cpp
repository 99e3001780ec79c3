#include "fleetmap/sensor/ellipsoidal_height.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/sensor/gpsd_fixes.hpp"
#include "fleetmap/sensor/mavlink_sensors.hpp"
#include "fleetmap/sensor/nmea_fixes.hpp"
#include "geometry/geoid_file.hpp"
#include "sensor/stamps.hpp"
#include "support/mavlink_packets.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::sensor {
namespace {

/// 0.1 m higher for each degree of latitude.
Geoid sloped_geoid() {
  const testing::TemporaryFolder folder;
  testing::write_sloped_geoid(folder.path(), "slope");
  setenv("GEOGRAPHICLIB_GEOID_PATH", folder.path().c_str(), 1);
  auto geoid = Geoid::load("slope");
  unsetenv("GEOGRAPHICLIB_GEOID_PATH");
  return geoid.value();
}

TEST(EllipsoidalHeight, FixesAboveSeaLevelGetTheGeoidsHeightAndOthersStay) {
  const Geoid geoid = sloped_geoid();
  Fix fix{.stamp = {}, .position = geo_point_from_degrees(40.0, -3.0, 600.0)};
  ASSERT_TRUE(make_ellipsoidal(fix, geoid));
  EXPECT_EQ(fix.position.altitude, 600.0);
  fix.above_sea_level = true;
  ASSERT_TRUE(make_ellipsoidal(fix, geoid));
  EXPECT_NEAR(fix.position.altitude, 604.0, 1e-6);
  EXPECT_FALSE(fix.above_sea_level);
  ASSERT_TRUE(make_ellipsoidal(fix, geoid)) << "not twice";
  EXPECT_NEAR(fix.position.altitude, 604.0, 1e-6);
}

TEST(EllipsoidalHeight, OfGpsdWithoutTheAltitudeAboveTheEllipsoid) {
  const Geoid geoid = sloped_geoid();
  for (const auto& [more, altitude] :
       {std::pair{"\"altMSL\":10.0", 14.0}, std::pair{"\"altHAE\":60.5", 60.5}}) {
    GpsdFixes fixes;
    auto found =
        fixes
            .add(bytes_of("{\"class\":\"TPV\",\"time\":\"2026-11-25T10:00:00Z\",\"lat\":40,\"lon\":2," +
                          std::string(more) + ",\"mode\":3}\n"))
            .fixes;
    ASSERT_EQ(found.size(), 1u);
    ASSERT_TRUE(make_ellipsoidal(found[0], geoid));
    EXPECT_NEAR(found[0].position.altitude, altitude, 1e-6);
  }
}

TEST(EllipsoidalHeight, OfNmeaWithoutTheHeightOfTheGeoid) {
  NmeaFixes fixes;
  // The checksum is the exclusive or of all that is between $ and *.
  std::string body = "GNGGA,101500.00,4000.000,N,00300.000,W,1,12,0.7,600.0,M,,M,,";
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char end[8];
  std::snprintf(end, sizeof end, "*%02X\r\n", sum);
  auto found = fixes.add(bytes_of(body.insert(0, "$").append(end)), Stamp{}).fixes;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].above_sea_level);
  ASSERT_TRUE(make_ellipsoidal(found[0], sloped_geoid()));
  EXPECT_NEAR(found[0].position.altitude, 604.0, 1e-6);
}

TEST(EllipsoidalHeight, OfMavlinkWithoutTheAltitudeAboveTheEllipsoid) {
  for (const auto& [stated, altitude] : {std::pair{650'000, 650.0}, std::pair{0, 603.9}}) {
    MavlinkSensors sensors;
    const Stamp now = kSwitchedOn + std::chrono::seconds(10);
    sensors.add(testing::system_time(0, 10'000), now);
    auto found = sensors.add(testing::gps_raw_int(10'000'000, 3, stated), now).fixes;
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].above_sea_level, stated == 0);
    ASSERT_TRUE(make_ellipsoidal(found[0], sloped_geoid()));
    EXPECT_NEAR(found[0].position.altitude, altitude, 1e-6);
  }
}

}  // namespace
}  // namespace fleetmap::sensor
