#include "fleetmap/agent/odometry_frame.hpp"

#include <gtest/gtest.h>

#include <string>

namespace fleetmap::agent {
namespace {

TEST(OdometryFrame, AdmitsNothingOfANewOriginBeforeASessionHasBegun) {
  OdometryFrame frame;
  odometry::LoamCounters counters;
  std::string why;
  bool disk_works = false;
  const auto begin = [&](const char* reason) {
    why = reason;
    if (disk_works) frame.begun(counters);
    return disk_works;
  };
  EXPECT_TRUE(frame.admits(counters, begin));
  EXPECT_EQ(why, "");
  ++counters.map_restarts;
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(frame.admits(counters, begin)) << "the disk is full";
  EXPECT_EQ(why, "odometry lost its way and began anew");
  disk_works = true;
  EXPECT_TRUE(frame.admits(counters, begin));
  why.clear();
  EXPECT_TRUE(frame.admits(counters, begin));
  EXPECT_EQ(why, "") << "it has begun";
}

TEST(OdometryFrame, ALidarClockThatJumpsBackIsANewOrigin) {
  OdometryFrame frame;
  odometry::LoamCounters counters;
  ++counters.clock_resets;
  std::string why;
  EXPECT_FALSE(frame.admits(counters, [&](const char* reason) {
    why = reason;
    return false;
  }));
  EXPECT_EQ(why, "the LiDAR's stamps jumped back");
  frame.begun(counters);
  EXPECT_TRUE(frame.admits(counters, [](const char*) { return false; }));
}

}  // namespace
}  // namespace fleetmap::agent
