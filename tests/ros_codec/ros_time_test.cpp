#include "ros_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::ros_codec {
namespace {

using ::testing::HasSubstr;

builtin_interfaces::msg::dds_::Time_ ros_time(std::int32_t sec, std::uint32_t nanosec) {
  builtin_interfaces::msg::dds_::Time_ time;
  time.sec(sec);
  time.nanosec(nanosec);
  return time;
}

TEST(RosTime, KeepsEveryNanosecond) {
  for (const std::int64_t ns : {0LL, 1LL, 999'999'999LL, 1'000'000'000LL, 1'700'000'000'123'456'789LL}) {
    const auto back = from_ros(to_ros(stamp_from_ns(ns)), "Imu");
    ASSERT_TRUE(back) << ns;
    EXPECT_EQ(to_ns(*back), ns);
  }
}

TEST(RosTime, StampsOutsideOf1970To2038AreClamped) {
  EXPECT_EQ(to_ros(stamp_from_ns(-1)).sec(), 0);
  EXPECT_EQ(to_ros(stamp_from_ns(-1)).nanosec(), 0u);
  const auto late = to_ros(stamp_from_ns(4'000'000'000'000'000'000));
  EXPECT_EQ(late.sec(), INT32_MAX);
  EXPECT_EQ(late.nanosec(), 0u);
}

TEST(RosTime, RefusesTimesThatAreNone) {
  const auto before = from_ros(ros_time(-1, 0), "Imu");
  ASSERT_FALSE(before);
  EXPECT_THAT(before.error().message, HasSubstr("Imu: header.stamp -1 s 0 ns is not a time"));
  const auto overflow = from_ros(ros_time(5, 1'000'000'000), "NavSatFix");
  ASSERT_FALSE(overflow);
  EXPECT_THAT(overflow.error().message, HasSubstr("NavSatFix: header.stamp 5 s 1000000000 ns"));
  EXPECT_TRUE(from_ros(ros_time(5, 999'999'999), "Imu"));
}

}  // namespace
}  // namespace fleetmap::ros_codec
