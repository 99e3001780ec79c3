#include "fleetmap/ros_codec/velodyne_scan.hpp"

#include <gmock/gmock.h>

namespace fleetmap::ros_codec {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kNow = 1'700'000'000'000'000'000;

VelodyneScan two_packets() {
  VelodyneScan scan{stamp_from_ns(kNow), {}};
  for (std::uint8_t fill = 1; fill <= 2; ++fill)
    scan.packets.push_back({stamp_from_ns(kNow + fill), Bytes(1206, fill)});
  return scan;
}

TEST(VelodyneScan, ComesBackAsItWasEncoded) {
  // Packets of 1206 bytes are padded to 4 bytes, wherever the frame's name ends.
  for (const char* frame : {"", "a", "ab", "abc", "velodyne"}) {
    const auto decoded = decode_velodyne_scan(encode(two_packets(), frame));
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(to_ns(decoded->stamp), kNow);
    ASSERT_EQ(decoded->packets.size(), 2u);
    EXPECT_EQ(to_ns(decoded->packets[1].received), kNow + 2);
    EXPECT_EQ(decoded->packets[1].data, Bytes(1206, 2));
  }
}

TEST(VelodyneScan, APacketWithoutATimeIsKept) {
  Bytes cdr = encode(two_packets(), "");
  // Encapsulation, stamp, frame and its padding, count, seconds of the first packet; then nanoseconds.
  constexpr std::size_t kNanoseconds = 4 + 8 + 8 + 4 + 4;
  cdr[kNanoseconds + 3] = 0xff;
  const auto decoded = decode_velodyne_scan(cdr);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(to_ns(decoded->packets[0].received), 0);
  EXPECT_EQ(to_ns(decoded->packets[1].received), kNow + 2);
}

TEST(VelodyneScan, OtherBytesAreRefused) {
  const Bytes whole = encode(two_packets());
  for (std::size_t size = 0; size < whole.size(); size += 3)
    EXPECT_FALSE(decode_velodyne_scan(ByteView(whole).first(size))) << size;
  Bytes many = encode(VelodyneScan{stamp_from_ns(kNow), {}}, "");
  ASSERT_EQ(many.size(), 24u);
  many[23] = 0x7f;
  EXPECT_THAT(decode_velodyne_scan(many).error().message, HasSubstr("too few for 2130706432 packets"));
}

}  // namespace
}  // namespace fleetmap::ros_codec
