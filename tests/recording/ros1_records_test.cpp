#include "recording/ros1_records.hpp"

#include <gmock/gmock.h>

#include "ros1_bag.hpp"

namespace fleetmap::recording::ros1 {
namespace {

using namespace recording::testing;
using ::testing::HasSubstr;

Record record_of(const std::string& bytes) {
  ByteView rest = view(bytes);
  const auto record = take_record(rest);
  EXPECT_TRUE(record);
  return record.value_or(Record{});
}

TEST(Ros1Records, FieldsAreFoundByName) {
  const std::string bytes = message(7, 5'000'000'009, "data") + "rest";
  ByteView rest = view(bytes);
  const auto taken = take_record(rest);
  ASSERT_TRUE(taken);
  EXPECT_EQ(rest.size(), 4u);
  EXPECT_EQ(taken->data.size(), 4u);
  EXPECT_EQ(op(*taken), Op::kMessage);
  EXPECT_EQ(read_message(*taken)->connection, 7u);
  EXPECT_EQ(read_message(*taken)->time, 5'000'000'009u);
  EXPECT_TRUE(field(*taken, "tim").empty());
  EXPECT_FALSE(read_connection(*taken));
  for (std::size_t size = 0; size + 4 < bytes.size(); ++size) {
    ByteView part = view(bytes).first(size);
    EXPECT_FALSE(take_record(part)) << size;
  }
}

TEST(Ros1Records, AConnectionHasItsTypeInASecondHeader) {
  const std::string bytes = connection(3, "/imu/data", "sensor_msgs/Imu");
  const auto read = read_connection(record_of(bytes));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->id, 3u);
  EXPECT_EQ(read->topic, "/imu/data");
  EXPECT_EQ(read->type, "sensor_msgs/Imu");
}

TEST(Ros1Records, AnIndexSaysWhenItsChunkBegins) {
  const std::string some = index(0, {30, 10, 20}), none = index(0, {});
  EXPECT_EQ(earliest(record_of(some)), 10u);
  EXPECT_EQ(earliest(record_of(none)), std::nullopt);
}

TEST(Ros1Records, OfAChunkAreUnpackedOrRefused) {
  const std::string records = message(1, 2, std::string(1000, 'a'));
  for (const char* compression : {"none", "bz2", "lz4"}) {
    std::string bytes = chunk(records, compression);
    const auto unpacked = unpack_records(record_of(bytes), 2000);
    ASSERT_TRUE(unpacked) << unpacked.error().message;
    EXPECT_TRUE(std::ranges::equal(*unpacked, view(records))) << compression;
    EXPECT_THAT(unpack_records(record_of(bytes), 100).error().message, HasSubstr("claims"));
    if (std::string(compression) == "none") continue;
    bytes[bytes.size() - 10] = static_cast<char>(~bytes[bytes.size() - 10]);
    EXPECT_FALSE(unpack_records(record_of(bytes), 2000)) << compression;
  }
  const std::string other = record({{"op", "\x05"}, {"compression", "zip"}, {"size", u32(4)}}, "abcd");
  EXPECT_THAT(unpack_records(record_of(other), 100).error().message,
              HasSubstr("'zip' is none of bz2 and lz4"));
}

}  // namespace
}  // namespace fleetmap::recording::ros1
