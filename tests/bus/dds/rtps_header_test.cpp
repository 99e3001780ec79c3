#include "bus/dds/rtps_header.hpp"

#include <gtest/gtest.h>

namespace fleetmap::bus::testing {
namespace {

/// An RTPS message of one INFO_TS and one DATA of this writer.
Bytes rtps_message(std::uint8_t first_of_writer) {
  Bytes bytes{'R', 'T', 'P', 'S', 2, 2, 1, 15, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  bytes.insert(bytes.end(), {0x09, 1, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  bytes.insert(bytes.end(), {0x15, 0x05, 24, 0, 0, 0, 16, 0, 0, 0, 0, 0, first_of_writer, 0, 1, 3});
  bytes.insert(bytes.end(), {0, 0, 0, 0, 1, 0, 0, 0, 7, 8, 9, 10});
  return bytes;
}

TEST(HelloIn, IsWhatAWriterOfHellosSent) {
  EXPECT_EQ(hello_in(rtps_message(0xff)), (Bytes{7, 8, 9, 10}));
  EXPECT_EQ(hello_in(rtps_message(0x12)), std::nullopt) << "a topic's";
}

TEST(HelloIn, NoMutilatedMessageHasOne) {
  const Bytes whole = rtps_message(0xff);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(hello_in(ByteView(whole).first(size)), std::nullopt) << size;
  Bytes other = whole;
  other[0] = 'M';
  EXPECT_EQ(hello_in(other), std::nullopt);
}

TEST(WithoutStatistics, IsTheMessageThatTheWriterMade) {
  const Bytes message = rtps_message(0x12);
  Bytes sent = message;
  sent.insert(sent.end(), {0x80, 0x01, 56, 0});
  sent.resize(message.size() + kStatisticsBytes);
  EXPECT_TRUE(ends_like_statistics(sent));
  const ByteView left = without_statistics(sent);
  EXPECT_EQ(Bytes(left.begin(), left.end()), message);
  EXPECT_EQ(without_statistics(message).size(), message.size());
  EXPECT_EQ(without_statistics(ByteView(sent).last(kStatisticsBytes)).size(), kStatisticsBytes)
      << "no RTPS message is that short";
}

}  // namespace
}  // namespace fleetmap::bus::testing
