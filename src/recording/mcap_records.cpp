#include "mcap_records.hpp"

#include <zlib.h>

#include "fleetmap/core/byte_fields.hpp"
#include "unpack.hpp"

namespace fleetmap::recording::mcap {
namespace {

template <class T>
std::optional<T> if_whole(const ByteFields& fields, T record) {
  return fields.whole() ? std::optional<T>(std::move(record)) : std::nullopt;
}

}  // namespace

Prefix read_prefix(ByteView bytes) {
  ByteFields fields(bytes);
  Prefix prefix;
  prefix.opcode = static_cast<Opcode>(fields.number<std::uint8_t>());
  prefix.length = fields.number<std::uint64_t>();
  return prefix;
}

std::optional<Schema> read_schema(ByteView content) {
  ByteFields fields(content);
  Schema schema;
  schema.id = fields.number<std::uint16_t>();
  schema.name = fields.text();
  return if_whole(fields, std::move(schema));
}

std::optional<Channel> read_channel(ByteView content) {
  ByteFields fields(content);
  Channel channel;
  channel.id = fields.number<std::uint16_t>();
  channel.schema = fields.number<std::uint16_t>();
  channel.topic = fields.text();
  channel.encoding = fields.text();
  return if_whole(fields, std::move(channel));
}

std::optional<Message> read_message(ByteView content) {
  ByteFields fields(content);
  Message message;
  message.channel = fields.number<std::uint16_t>();
  fields.number<std::uint32_t>();  // sequence
  message.log_time = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // time of publication
  message.data = fields.rest();
  return if_whole(fields, message);
}

std::optional<Chunk> read_chunk(ByteView content) {
  ByteFields fields(content);
  Chunk chunk;
  chunk.start = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // the latest log time
  chunk.unpacked_bytes = fields.number<std::uint64_t>();
  chunk.crc = fields.number<std::uint32_t>();
  chunk.compression = fields.text();
  chunk.records = fields.take(fields.number<std::uint64_t>());
  return if_whole(fields, std::move(chunk));
}

std::uint64_t start_of(Opcode opcode, ByteView content) {
  if (opcode == Opcode::kChunk) return ByteFields(content).number<std::uint64_t>();
  const auto message = read_message(content);
  return message ? message->log_time : 0;
}

std::optional<std::uint64_t> read_footer(ByteView content) {
  ByteFields fields(content);
  const auto summary_start = fields.number<std::uint64_t>();
  return if_whole(fields, summary_start);
}

Result<Bytes> unpack_records(const Chunk& chunk, std::size_t max_bytes) {
  if (chunk.unpacked_bytes > max_bytes)
    return failure("claims " + std::to_string(chunk.unpacked_bytes) + " bytes");
  Result<Bytes> records = Bytes();
  if (chunk.compression.empty()) {
    records->assign(chunk.records.begin(), chunk.records.end());
  } else if (chunk.compression == "zstd") {
    records = unpack_zstd(chunk.records, chunk.unpacked_bytes);
  } else if (chunk.compression == "lz4") {
    records = unpack_lz4(chunk.records, chunk.unpacked_bytes);
  } else {
    return failure("its compression '" + chunk.compression + "' is none of lz4 and zstd");
  }
  if (!records) return records;
  if (records->size() != chunk.unpacked_bytes) return failure("unpacks to fewer bytes than it claims");
  if (chunk.crc != 0 && crc32_z(0, records->data(), records->size()) != chunk.crc)
    return failure("its checksum is wrong");
  return records;
}

}  // namespace fleetmap::recording::mcap
