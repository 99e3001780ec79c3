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

}  // namespace
}  // namespace fleetmap::apps
