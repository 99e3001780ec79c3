#include "bus/dds/payload.hpp"

#include <gtest/gtest.h>

namespace fleetmap::bus {
namespace {

using eprosima::fastrtps::rtps::CacheChange_t;
using eprosima::fastrtps::rtps::IPayloadPool;
using eprosima::fastrtps::rtps::SerializedPayload_t;

/// A CDR message of `size` bytes, its header included.
Bytes cdr_of_size(std::size_t size) {
  Bytes cdr{0, 1, 0, 0};
  while (cdr.size() < size) cdr.push_back(static_cast<std::uint8_t>(0xf0 + cdr.size()));
  return cdr;
}

TEST(Payload, ComesBackWithItsSizeThoughItIsPadded) {
  for (std::size_t size = 4; size <= 13; ++size) {
    SerializedPayload_t payload(64);
    ASSERT_TRUE(write_payload(cdr_of_size(size), payload));
    EXPECT_EQ(payload.length, (size + 3) / 4 * 4);
    EXPECT_EQ(payload.length, payload_size(cdr_of_size(size)));
    EXPECT_EQ(payload.data[3], payload.length - size) << "DDS-XTypes 1.3, 7.6.3.1.2";
    for (std::size_t k = size; k < payload.length; ++k) EXPECT_EQ(payload.data[k], 0);
    Bytes read{9, 9};
    ASSERT_TRUE(read_payload(payload, read));
    EXPECT_EQ(read, cdr_of_size(size));
  }
}

TEST(Payload, OtherOptionsOfTheHeaderStay) {
  Bytes cdr = cdr_of_size(6);
  cdr[2] = 0xab;
  cdr[3] = 0xfc;
  SerializedPayload_t payload(64);
  ASSERT_TRUE(write_payload(cdr, payload));
  EXPECT_EQ(payload.data[3], 0xfc | 2);
  Bytes read;
  ASSERT_TRUE(read_payload(payload, read));
  EXPECT_EQ(read, cdr);
}

TEST(Payload, TellsTheByteOrder) {
  SerializedPayload_t payload(64);
  ASSERT_TRUE(write_payload(cdr_of_size(8), payload));
  EXPECT_EQ(payload.encapsulation, CDR_LE);
  ASSERT_TRUE(write_payload({0, 0, 0, 0, 1, 2, 3, 4}, payload));
  EXPECT_EQ(payload.encapsulation, CDR_BE);
}

TEST(Payload, PayloadWithoutHeaderOrRoomIsRefused) {
  SerializedPayload_t payload(8);
  EXPECT_FALSE(write_payload({0, 1, 0}, payload));
  EXPECT_FALSE(write_payload(cdr_of_size(9), payload)) << "12 with its padding";
  EXPECT_TRUE(write_payload(cdr_of_size(8), payload));
  Bytes read;
  payload.length = 3;
  EXPECT_FALSE(read_payload(payload, read));
  payload.length = 6;
  payload.data[3] = 3;
  EXPECT_FALSE(read_payload(payload, read)) << "more padding than there are bytes";
  payload.data[3] = 2;
  EXPECT_TRUE(read_payload(payload, read));
  EXPECT_EQ(read, (Bytes{0, 1, 0, 0}));
}

TEST(PayloadPool, GivesMemoryUpToTheLargestMessageAndTakesItBack) {
  PayloadPool pool;
  CacheChange_t change;
  EXPECT_FALSE(pool.get_payload((4u << 20) + 1, change)) << "a fragment may announce 4 GiB";
  EXPECT_EQ(change.payload_owner(), nullptr);
  ASSERT_TRUE(pool.get_payload(4u << 20, change));
  EXPECT_EQ(change.serializedPayload.max_size, 4u << 20);
  EXPECT_EQ(change.payload_owner(), &pool);
  ASSERT_TRUE(pool.release_payload(change));
  EXPECT_EQ(change.serializedPayload.data, nullptr);
  EXPECT_EQ(change.payload_owner(), nullptr);
}

TEST(PayloadPool, CopiesAPayloadOfSomebodyElse) {
  PayloadPool pool;
  SerializedPayload_t theirs(64);
  ASSERT_TRUE(write_payload(cdr_of_size(11), theirs));
  CacheChange_t change;
  IPayloadPool* owner = nullptr;
  ASSERT_TRUE(pool.get_payload(theirs, owner, change));
  EXPECT_EQ(change.serializedPayload, theirs);
  EXPECT_NE(change.serializedPayload.data, theirs.data);
  EXPECT_EQ(change.payload_owner(), &pool);
  ASSERT_TRUE(pool.release_payload(change));
  theirs.length = (4u << 20) + 1;
  EXPECT_FALSE(pool.get_payload(theirs, owner, change));
  theirs.length = 0;
}

}  // namespace
}  // namespace fleetmap::bus
