#include "bus/dds/rtps_messages.hpp"

#include <fastrtps/utils/IPLocator.h>
#include <gtest/gtest.h>

#include <limits>

namespace fleetmap::bus {
namespace {

namespace rtps = eprosima::fastrtps::rtps;

std::uint32_t first_bytes(const std::string& text) {
  const ContentHash hash = content_hash({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return static_cast<std::uint32_t>(hash[0] << 16 | hash[1] << 8 | hash[2]);
}

TEST(EntityIds, AreThoseOfUserWritersWithoutKey) {
  const rtps::EntityId_t id = writer_id(0x12abcd);
  EXPECT_EQ(id.value[0], 0x12);
  EXPECT_EQ(id.value[1], 0xab);
  EXPECT_EQ(id.value[2], 0xcd);
  EXPECT_EQ(id.value[3], 0x03) << "RTPS 2.2, 9.3.1.2";
  EXPECT_EQ(key_of(id), 0x12abcdu);
  EXPECT_EQ(key_of(writer_id(kHelloWriters + 300)), kHelloWriters + 300);
}

TEST(EntityIds, OfATopicFollowFromItsNameAndType) {
  const Topic topic{Link::kLongRange, "fleetmap/node", "Node", "small"};
  EXPECT_EQ(key_of(topic), first_bytes("fleetmap/node|Node"));
  Topic other = topic;
  other.profile = "cloud";
  other.link = Link::kShortRange;
  EXPECT_EQ(key_of(other), key_of(topic));
  other.type = "Cloud";
  EXPECT_NE(key_of(other), key_of(topic));
}

TEST(EntityIds, OfTopicsAreNeverThoseOfHellos) {
  int moved = 0;
  for (int k = 0; k < 3000; ++k) {
    const Topic topic{Link::kLongRange, "fleetmap/hold/r" + std::to_string(k), "Hold", "small"};
    const std::uint32_t hash = first_bytes(topic.name + "|Hold");
    ASSERT_LT(key_of(topic), kHelloWriters);
    if (hash < kHelloWriters) continue;
    ++moved;
    EXPECT_EQ(key_of(topic), hash - 0x800000);
  }
  EXPECT_GT(moved, 3) << "one in 256 begins with ff";
}

TEST(RtpsMessages, AnAddressIsReadableWithItsPort) {
  rtps::Locator_t locator;
  rtps::IPLocator::setIPv4(locator, "10.0.0.2");
  locator.port = 7660;
  EXPECT_EQ(to_text(locator), "10.0.0.2:7660");
}

TEST(RtpsMessages, EndpointsOnRadiosRepeatNothingAndShareNoMemory) {
  const auto attributes = best_effort<rtps::WriterAttributes>();
  EXPECT_EQ(attributes.endpoint.reliabilityKind, rtps::BEST_EFFORT);
  EXPECT_EQ(attributes.endpoint.durabilityKind, rtps::VOLATILE);
  EXPECT_EQ(attributes.endpoint.topicKind, rtps::NO_KEY);
  EXPECT_EQ(attributes.endpoint.data_sharing_configuration().kind(), eprosima::fastdds::dds::OFF);
  EXPECT_EQ(unbounded_history().maximumReservedCaches, 0) << "0 is unlimited";
}

TEST(RtpsMessages, TheAgeOfAStampIsSignedSoThatClocksMayDiffer) {
  rtps::Time_t stamp;
  rtps::Time_t::now(stamp);
  stamp.seconds(stamp.seconds() - 100);
  EXPECT_GE(since(stamp), std::chrono::seconds(100));
  EXPECT_LT(since(stamp), std::chrono::seconds(200));
  stamp.seconds(stamp.seconds() + 3700);
  EXPECT_LT(since(stamp), -std::chrono::seconds(3000));
}

TEST(RtpsMessages, AStampThatNoClockShowsHasNoAge) {
  EXPECT_FALSE(since(rtps::c_RTPSTimeInvalid)) << "of a message without one";
  EXPECT_FALSE(since(rtps::Time_t(std::numeric_limits<std::int32_t>::max(), 0)));
  EXPECT_FALSE(since(rtps::Time_t(std::numeric_limits<std::int32_t>::min(), 0)));
  EXPECT_FALSE(since(rtps::Time_t(0, 0)));
}

}  // namespace
}  // namespace fleetmap::bus
