#include "fleetmap/ros_codec/livox_points.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "support/livox_message.hpp"

namespace fleetmap::ros_codec {
namespace {

using fleetmap::testing::LivoxMessage;
using ::testing::HasSubstr;

constexpr std::uint64_t kTimebase = 1'700'000'000'000'000'000;

LivoxMessage three_points() {
  return {.stamp = kTimebase,
          .timebase = kTimebase,
          .points = {{.offset_time = 0, .x = 1.5f, .y = -2.5f, .z = 0.25f, .reflectivity = 77, .line = 0},
                     {.offset_time = 50'000'000, .x = 10.0f, .line = 3},
                     {.offset_time = 99'995'000, .x = 20.0f, .line = 5}}};
}

TEST(LivoxPoints, AreTheScanThatTheMessageDefines) {
  for (const char* frame : {"", "a", "ab", "abc", "livox_frame"}) {
    LivoxMessage message = three_points();
    message.frame = frame;
    const auto decoded = decode_livox(message.cdr());
    ASSERT_TRUE(decoded) << decoded.error().message;
    const sensor::Scan& scan = decoded->scan;
    EXPECT_EQ(to_ns(scan.stamp), static_cast<std::int64_t>(kTimebase));
    EXPECT_TRUE(scan.has_ring && scan.has_time);
    ASSERT_EQ(scan.points.size(), 3u);
    EXPECT_EQ(scan.points[0].position, Eigen::Vector3f(1.5f, -2.5f, 0.25f));
    EXPECT_EQ(scan.points[0].intensity, 77.0f);
    EXPECT_EQ(scan.points[1].ring, 3);
    EXPECT_FLOAT_EQ(scan.points[1].time, 0.05f);
    EXPECT_FLOAT_EQ(scan.points[2].time, 0.099995f);
    EXPECT_FALSE(decoded->foreign_clock);
  }
}

TEST(LivoxPoints, TimesCountFromTheHeadersStamp) {
  LivoxMessage message = three_points();
  message.stamp += 100'000'000;  // a driver that stamps the end of its scan
  const auto decoded = decode_livox(message.cdr());
  ASSERT_TRUE(decoded);
  EXPECT_FLOAT_EQ(decoded->scan.points[0].time, -0.1f);
  EXPECT_FLOAT_EQ(decoded->scan.points[1].time, -0.05f);
}

TEST(LivoxPoints, ATimebaseOfAnotherClockIsTheHeadersStamp) {
  for (const std::uint64_t timebase :
       {std::uint64_t{0}, std::uint64_t{140'000'000'000}, std::numeric_limits<std::uint64_t>::max()}) {
    LivoxMessage message = three_points();
    message.timebase = timebase;
    const auto decoded = decode_livox(message.cdr());
    ASSERT_TRUE(decoded);
    EXPECT_FLOAT_EQ(decoded->scan.points[1].time, 0.05f) << timebase;
    EXPECT_EQ(decoded->foreign_clock, timebase != 0) << timebase;
  }
}

TEST(LivoxPoints, WithoutOffsetsThereAreNoTimes) {
  LivoxMessage message = three_points();
  for (LivoxMessage::Point& point : message.points) point.offset_time = 5;
  EXPECT_FALSE(decode_livox(message.cdr())->scan.has_time);
}

TEST(LivoxPoints, NoiseIsLeftOutByItsTag) {
  const auto kept = [](unsigned tag) {
    LivoxMessage message = three_points();
    message.points[1].tag = static_cast<std::uint8_t>(tag);
    const auto decoded = decode_livox(message.cdr());
    EXPECT_EQ(decoded->scan.points.size() + decoded->noise_points, 3u);
    return decoded->noise_points == 0;
  };
  for (const unsigned returns : {0x00u, 0x10u, 0x20u, 0x30u}) {
    EXPECT_TRUE(kept(returns)) << returns;
    EXPECT_TRUE(kept(returns | 0b00'11)) << "hardly noise, by its position";
    EXPECT_FALSE(kept(returns | 0b00'01)) << "noise by its position";
    EXPECT_FALSE(kept(returns | 0b00'10)) << "likely noise by its position";
    EXPECT_FALSE(kept(returns | 0b01'00)) << "noise by its intensity";
    EXPECT_FALSE(kept(returns | 0b10'00)) << "perhaps noise by its intensity";
    EXPECT_FALSE(kept(returns | 0b01'000000)) << "distorted by a near return";
  }
}

TEST(LivoxPoints, PointsWithoutAReturnAreCounted) {
  LivoxMessage message = three_points();
  message.points[0].x = message.points[0].y = message.points[0].z = 0.0f;
  message.points[1].y = std::numeric_limits<float>::quiet_NaN();
  const auto decoded = decode_livox(message.cdr());
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->scan.points.size(), 1u);
  EXPECT_EQ(decoded->origin_points, 1u);
  EXPECT_EQ(decoded->non_finite_points, 1u);
}

TEST(LivoxPoints, ComeBackAsTheyWereEncoded) {
  const sensor::Scan scan = decode_livox(three_points().cdr())->scan;
  const auto back = decode_livox(encode_livox(scan, "a"));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->scan.stamp, scan.stamp);
  ASSERT_EQ(back->scan.points.size(), scan.points.size());
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    EXPECT_EQ(back->scan.points[k].position, scan.points[k].position);
    EXPECT_EQ(back->scan.points[k].intensity, scan.points[k].intensity);
    EXPECT_EQ(back->scan.points[k].ring, scan.points[k].ring);
    EXPECT_NEAR(back->scan.points[k].time, scan.points[k].time, 1e-8);
  }
}

TEST(LivoxPoints, OtherBytesAreRefused) {
  const Bytes whole = three_points().cdr();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode_livox(ByteView(whole).first(size))) << size;
  LivoxMessage many{.stamp = kTimebase, .frame = "", .points = {}};
  Bytes hostile = many.cdr();
  hostile.back() = 0x7f;  // the highest byte of the number of points
  EXPECT_THAT(decode_livox(hostile).error().message, HasSubstr("too few for 2130706432 points"));
  Bytes contradictory = many.cdr();
  contradictory[contradictory.size() - 12] = 5;
  EXPECT_THAT(decode_livox(contradictory).error().message, HasSubstr("point_num 5 contradicts its 0 points"));
  Bytes negative = whole;
  negative[7] = 0x80;  // seconds
  EXPECT_THAT(decode_livox(negative).error().message, HasSubstr("is not a time"));
}

}  // namespace
}  // namespace fleetmap::ros_codec
