#include "recordings/stream_summary.hpp"

#include <gmock/gmock.h>

#include <sstream>

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

TEST(StreamSummary, CountsRatesAndGapsOfEachSensor) {
  StreamSummary streams;
  for (const double seconds : {0.0, 0.1, 0.2, 0.7, 0.8}) {
    sensor::Scan scan;
    scan.stamp = Stamp{} + from_seconds(seconds);
    streams.add(scan);
  }
  sensor::Imu imu;
  streams.add(imu);
  EXPECT_EQ(streams.scans(), 5u);
  std::ostringstream text;
  streams.print(text);
  EXPECT_THAT(text.str(), HasSubstr("LiDAR          5       0.8 s     5.0 Hz, longest gap 0.50 s\n"));
  EXPECT_THAT(text.str(), HasSubstr("IMU            1\n"));
  EXPECT_THAT(text.str(), HasSubstr("GPS            0  none\n"));
}

TEST(StreamSummary, FixesWithoutAPositionAreToldFromNoFix) {
  StreamSummary streams;
  EXPECT_FALSE(streams.fixes_without_place(true)) << "none came";
  streams.add(sensor::Fix{.stamp = {}, .position = {}, .valid = false});
  streams.add(sensor::Fix{.stamp = {}, .position = {}, .valid = false});
  EXPECT_THAT(streams.fixes_without_place(true).value_or(""),
              HasSubstr("2 fixes came, all without a position (status -1): check the antenna"));
  EXPECT_FALSE(streams.fixes_without_place(false)) << "gps.use: false";
  streams.add(sensor::Fix{});
  EXPECT_FALSE(streams.fixes_without_place(true));
}

}  // namespace
}  // namespace fleetmap::apps
