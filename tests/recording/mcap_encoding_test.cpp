#include "recording/mcap_encoding.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

namespace fleetmap::recording::mcap {
namespace {

/// The content of a record, whose prefix is checked.
ByteView content_of(ByteView record, Opcode opcode) {
  const Prefix prefix = read_prefix(record);
  EXPECT_EQ(prefix.opcode, opcode);
  EXPECT_EQ(prefix.length, record.size() - kPrefixBytes);
  return record.subspan(kPrefixBytes);
}

TEST(McapEncoding, SchemasChannelsAndMessagesAreReadAgain) {
  const Bytes schema_bytes = schema_record(3, "sensor_msgs/msg/Imu", "ros2msg", "float64 x\n");
  const auto schema = read_schema(content_of(schema_bytes, Opcode::kSchema));
  ASSERT_TRUE(schema);
  EXPECT_EQ(schema->id, 3);
  EXPECT_EQ(schema->name, "sensor_msgs/msg/Imu");
  const Bytes channel_bytes = channel_record(7, 3, "/imu", {{"offered_qos_profiles", "- history: 1"}});
  const auto channel = read_channel(content_of(channel_bytes, Opcode::kChannel));
  ASSERT_TRUE(channel);
  EXPECT_EQ(channel->id, 7);
  EXPECT_EQ(channel->schema, 3);
  EXPECT_EQ(channel->topic, "/imu");
  EXPECT_EQ(channel->encoding, "cdr");
  Bytes records;
  append_message(records, 7, 1, 1'700'000'000'000'000'123, Bytes{1, 2, 3});
  const auto message = read_message(content_of(records, Opcode::kMessage));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, 7);
  EXPECT_EQ(message->log_time, 1'700'000'000'000'000'123u);
  EXPECT_EQ(Bytes(message->data.begin(), message->data.end()), (Bytes{1, 2, 3}));
}

TEST(McapEncoding, AChunkHasItsTimesSizesAndChecksum) {
  const Bytes unpacked{1, 2, 3, 4}, packed{9, 8};
  const Bytes record = chunk_record({5, 8}, unpacked, "lz4", packed);
  const auto chunk = read_chunk(content_of(record, Opcode::kChunk));
  ASSERT_TRUE(chunk);
  EXPECT_EQ(chunk->start, 5u);
  EXPECT_EQ(chunk->unpacked_bytes, 4u);
  EXPECT_EQ(chunk->crc, crc32_z(0, unpacked.data(), unpacked.size()));
  EXPECT_EQ(chunk->compression, "lz4");
  EXPECT_EQ(Bytes(chunk->records.begin(), chunk->records.end()), packed);
}

TEST(McapEncoding, IndexesAreThoseOfTheSpecification) {
  EXPECT_EQ(message_index_record(2, {{3, 4}}), (Bytes{0x07, 22, 0, 0, 0, 0, 0, 0, 0, 2, 0, 16, 0, 0, 0, 3,
                                                      0,    0,  0, 0, 0, 0, 0, 4, 0, 0, 0, 0,  0, 0, 0}));
  EXPECT_EQ(summary_offset_record(Opcode::kChannel, 0x1234, 5),
            (Bytes{0x0e, 17, 0, 0, 0, 0, 0, 0, 0, 4, 0x34, 0x12, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(data_end_record(0x01020304), (Bytes{0x0f, 4, 0, 0, 0, 0, 0, 0, 0, 4, 3, 2, 1}));
}

TEST(McapEncoding, TheFootersChecksumCoversTheFooter) {
  const Bytes summary{1, 2, 3};
  const auto before = static_cast<std::uint32_t>(crc32_z(0, summary.data(), summary.size()));
  const Bytes footer = footer_record(100, 103, before);
  EXPECT_EQ(read_footer(content_of(footer, Opcode::kFooter)), 100u);
  ASSERT_EQ(footer.size(), kPrefixBytes + kFooterBytes);
  Bytes covered = summary;
  covered.insert(covered.end(), footer.begin(), footer.end() - 4);
  std::uint32_t crc = 0;
  for (std::size_t k = 4; k > 0; --k) crc = crc << 8 | footer[footer.size() - 5 + k];
  EXPECT_EQ(crc, crc32_z(0, covered.data(), covered.size()));
}

}  // namespace
}  // namespace fleetmap::recording::mcap
