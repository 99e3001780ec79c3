#include "bus/dds/hello.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "trust/fleet_of_keys.hpp"

namespace fleetmap::bus {
namespace {

using fleetmap::testing::agent;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;

Introduction introduction(std::uint8_t number) {
  return {.prefix = {1, 15, 3, 4, 5, 6, 7, 8, 9, 10, 11, number},
          .agent = agent("r3"),
          .address = {10, 0, 0, number},
          .port = 7660,
          .heard_ago = milliseconds(2300),
          .joined_ago = seconds(17)};
}

/// All members differ from their defaults.
Hello whole() {
  Hello hello;
  hello.knows = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  hello.leaves = true;
  hello.sender = agent("rover-12");
  hello.address = {10, 0, 0, 2};
  hello.port = 0x1dec;
  hello.settings = FleetSettings{
      .wire_schema = 3, .fleet = 0xfedcba98, .submap_voxel = 1000, .map_voxel = 65535, .placement = 7};
  hello.link = Link::kShortRange;
  hello.multicast = true;
  hello.reads = {0xff0000, 1};
  hello.joined_ago = seconds(200);
  hello.seeks = 9;
  hello.introduces = {introduction(1), introduction(2)};
  return hello;
}

TEST(HelloCodec, EveryMemberComesBack) {
  const auto hello = decode_hello(encode(whole()));
  ASSERT_TRUE(hello);
  EXPECT_EQ(hello->knows, whole().knows);
  EXPECT_TRUE(hello->leaves);
  EXPECT_EQ(hello->sender, whole().sender);
  EXPECT_EQ(hello->address, whole().address);
  EXPECT_EQ(hello->port, whole().port);
  EXPECT_EQ(hello->settings, whole().settings);
  EXPECT_EQ(hello->link, Link::kShortRange);
  EXPECT_TRUE(hello->multicast);
  EXPECT_EQ(hello->reads, whole().reads);
  EXPECT_EQ(hello->joined_ago, seconds(200));
  EXPECT_EQ(hello->seeks, 9);
  EXPECT_EQ(hello->introduces, whole().introduces);
}

TEST(HelloCodec, TheHeadStaysWhereOtherVersionsLookForIt) {
  const Bytes bytes = encode(whole());
  const Bytes head{0,  1, 0,   0,   4,   1,   2,   3,   4,   5,   6,  7, 8, 9, 10,   11,
                   12, 1, 'r', 'o', 'v', 'e', 'r', '-', '1', '2', 10, 0, 0, 2, 0xec, 0x1d};
  ASSERT_GE(bytes.size(), head.size());
  EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(head.size())), head);
}

TEST(HelloCodec, NoPartOfAHelloIsOne) {
  const Bytes bytes = encode(whole());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_hello({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
}

TEST(HelloCodec, NamesPortsAndLinksAreChecked) {
  constexpr std::size_t kName = 18, kPort = 30;
  Bytes bytes = encode(whole());
  bytes[kName] = 'R';
  EXPECT_FALSE(decode_hello(bytes)) << "no robot has a capital";
  std::fill_n(bytes.begin() + kName, 8, std::uint8_t{0});
  EXPECT_FALSE(decode_hello(bytes)) << "nor no name";
  bytes = encode(whole());
  bytes[kPort] = bytes[kPort + 1] = 0;
  EXPECT_FALSE(decode_hello(bytes));
  Hello onboard = whole();
  onboard.link = Link::kOnboard;
  EXPECT_FALSE(decode_hello(encode(onboard)));
  onboard.link = static_cast<Link>(3);
  EXPECT_FALSE(decode_hello(encode(onboard)));
}

TEST(HelloCodec, AsMuchAsFitsIntoOnePacketAndNoMore) {
  Hello hello = whole();
  hello.reads.assign(kMaxReads, 7);
  hello.introduces.assign(kMaxIntroductions, introduction(1));
  const auto largest = decode_hello(encode(hello));
  ASSERT_TRUE(largest);
  EXPECT_EQ(largest->reads.size(), kMaxReads);
  EXPECT_EQ(largest->introduces.size(), kMaxIntroductions);
  hello.introduces.pop_back();
  hello.reads.push_back(7);
  EXPECT_FALSE(decode_hello(encode(hello)));
}

TEST(HelloCodec, TimesAreRoundedDownAndHeldAtTheirBounds) {
  Hello hello = whole();
  hello.joined_ago = milliseconds(1999);
  hello.introduces[0].heard_ago = milliseconds(199);
  hello.introduces[0].joined_ago = -seconds(5);
  hello.introduces[1].heard_ago = std::chrono::hours(5);
  hello.introduces[1].joined_ago = seconds(256);
  const auto heard = decode_hello(encode(hello));
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->joined_ago, seconds(1));
  EXPECT_EQ(heard->introduces[0].heard_ago, milliseconds(100));
  EXPECT_EQ(heard->introduces[0].joined_ago, seconds(0));
  EXPECT_EQ(heard->introduces[1].heard_ago, milliseconds(6553500));
  EXPECT_EQ(heard->introduces[1].joined_ago, seconds(255));
}

TEST(HelloCodec, AnIntroductionOfNobodyIsLeftOut) {
  Hello hello = whole();
  hello.introduces[0].port = 0;
  const auto heard = decode_hello(encode(hello));
  ASSERT_TRUE(heard);
  EXPECT_THAT(heard->introduces, ElementsAre(introduction(2)));
}

TEST(HelloCodec, TheFirstVersionHadAnotherHead) {
  Bytes bytes = encode(whole());
  bytes[4] = 1;
  EXPECT_FALSE(decode_hello(bytes));
  EXPECT_FALSE(decode_other_hello(bytes));
  bytes[4] = 2;
  bytes[30] = bytes[31] = 0;
  EXPECT_FALSE(decode_other_hello(bytes)) << "nobody is at port 0";
}

}  // namespace
}  // namespace fleetmap::bus
