#include "recording/mcap_records.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

namespace fleetmap::recording::mcap {
namespace {

using ::testing::HasSubstr;

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
template <class T>
Bytes number(T value) {
  Bytes bytes;
  for (std::size_t k = 0; k < sizeof(T); ++k) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
  return bytes;
}
Bytes text(const std::string& value) {
  return number(static_cast<std::uint32_t>(value.size())) + Bytes(value.begin(), value.end());
}

/// Reads each shorter part of a record's content, none of which may be taken for the whole.
template <class Read>
void expect_only_whole(const Bytes& content, std::size_t needed, Read read) {
  EXPECT_TRUE(read(content));
  for (std::size_t size = 0; size < needed; ++size) EXPECT_FALSE(read(ByteView(content).first(size))) << size;
}

TEST(McapRecords, AreReadFieldByField) {
  const Bytes schema = number<std::uint16_t>(3) + text("sensor_msgs/msg/Imu") + text("ros2msg") + text("...");
  EXPECT_EQ(read_schema(schema)->id, 3);
  EXPECT_EQ(read_schema(schema)->name, "sensor_msgs/msg/Imu");
  const Bytes channel = number<std::uint16_t>(7) + number<std::uint16_t>(3) + text("/imu") + text("cdr") +
                        number<std::uint32_t>(0);
  EXPECT_EQ(read_channel(channel)->id, 7);
  EXPECT_EQ(read_channel(channel)->schema, 3);
  EXPECT_EQ(read_channel(channel)->topic, "/imu");
  EXPECT_EQ(read_channel(channel)->encoding, "cdr");
  const Bytes message = number<std::uint16_t>(7) + number<std::uint32_t>(1) +
                        number<std::uint64_t>(1234567890123) + number<std::uint64_t>(5) + Bytes{9, 8};
  EXPECT_EQ(read_message(message)->channel, 7);
  EXPECT_EQ(read_message(message)->log_time, 1234567890123u);
  EXPECT_TRUE(std::ranges::equal(read_message(message)->data, Bytes{9, 8}));
  EXPECT_EQ(read_footer(number<std::uint64_t>(77) + number<std::uint64_t>(0) + number<std::uint32_t>(0)),
            77u);
  EXPECT_EQ(read_prefix(Bytes{5} + number<std::uint64_t>(300)).length, 300u);
  EXPECT_EQ(start_of(Opcode::kChunk, number<std::uint64_t>(42)), 42u);
  EXPECT_EQ(start_of(Opcode::kMessage, ByteView(message).first(kTimesBytes)), 1234567890123u);

  expect_only_whole(schema, 25, read_schema);
  expect_only_whole(channel, 15, read_channel);
  expect_only_whole(message, 22, read_message);
}

Bytes chunk_of(const Bytes& records, std::uint64_t claimed, std::uint32_t crc,
               const std::string& compression) {
  return number<std::uint64_t>(1) + number<std::uint64_t>(2) + number(claimed) + number(crc) +
         text(compression) + number<std::uint64_t>(records.size()) + records;
}

std::string why_not(const Bytes& content, std::size_t max_bytes = 1000) {
  const auto records = unpack_records(*read_chunk(content), max_bytes);
  return records ? "unpacked" : records.error().message;
}

TEST(McapRecords, OfAChunkAreCheckedAgainstWhatItClaims) {
  const Bytes records{1, 2, 3, 4};
  const auto crc = static_cast<std::uint32_t>(crc32_z(0, records.data(), records.size()));
  const Bytes good = chunk_of(records, 4, crc, "");
  expect_only_whole(good, good.size(), read_chunk);
  EXPECT_EQ(unpack_records(*read_chunk(good), 1000), records);
  EXPECT_EQ(why_not(chunk_of(records, 4, 0, "")), "unpacked") << "0 is no checksum";
  EXPECT_THAT(why_not(chunk_of(records, 4, crc ^ 1, "")), HasSubstr("checksum"));
  EXPECT_THAT(why_not(chunk_of(records, 5, 0, "")), HasSubstr("fewer bytes"));
  EXPECT_THAT(why_not(chunk_of(records, std::uint64_t{1} << 60, 0, "zstd")), HasSubstr("claims"));
  EXPECT_THAT(why_not(chunk_of(records, 4, 0, "zstd")), HasSubstr("damaged zstd"));
  EXPECT_THAT(why_not(chunk_of(records, 4, 0, "lz4")), HasSubstr("lz4"));
  EXPECT_THAT(why_not(chunk_of(records, 4, 0, "brotli")), HasSubstr("'brotli' is none of lz4 and zstd"));
}

}  // namespace
}  // namespace fleetmap::recording::mcap
