#include "monitor/foxglove/basic_types.hpp"

#include <gtest/gtest.h>

#include "monitor/foxglove/cdr_reader.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using testing::CdrReader;

TEST(BasicTypes, a_stamp_is_seconds_and_nanoseconds) {
  const auto read = [](std::int64_t ns) {
    CdrWriter cdr;
    write(cdr, stamp_from_ns(ns));
    CdrReader reader(std::move(cdr).message());
    const std::uint32_t sec = reader.count();
    return std::pair(sec, reader.count());
  };
  EXPECT_EQ(read(1'700'000'000'123'456'789), (std::pair{1'700'000'000u, 123'456'789u}));
  EXPECT_EQ(read(0), (std::pair{0u, 0u}));
  EXPECT_EQ(read(-5), (std::pair{0u, 0u})) << "before 1970";
  EXPECT_EQ(read(std::numeric_limits<std::int64_t>::max()), (std::pair{4'294'967'295u, 999'999'999u}));
}

TEST(BasicTypes, a_pose_is_its_position_and_quaternion_with_w_last) {
  const Pose T = make_pose(rotation_from_rpy(0.0, 0.0, 0.5), Eigen::Vector3d(1.0, -2.0, 3.0));
  CdrWriter cdr;
  write(cdr, T);
  CdrReader read(std::move(cdr).message());
  EXPECT_EQ(read.numbers(3), (std::vector<double>{1.0, -2.0, 3.0}));
  const auto q = read.numbers(4);
  EXPECT_NEAR(q[2], std::sin(0.25), 1e-12);
  EXPECT_NEAR(q[3], std::cos(0.25), 1e-12);
  EXPECT_TRUE(read.at_end());
}

TEST(BasicTypes, colours_are_shares) {
  CdrWriter cdr;
  write(cdr, color_of(0xff3300));
  CdrReader read(std::move(cdr).message());
  EXPECT_EQ(read.numbers(4), (std::vector<double>{1.0, 0.2, 0.0, 1.0}));
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
