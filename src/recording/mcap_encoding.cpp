#include "mcap_encoding.hpp"

#include <zlib.h>

#include <concepts>

namespace fleetmap::recording::mcap {
namespace {

template <std::unsigned_integral T>
void put(Bytes& into, T number) {
  for (std::size_t k = 0; k < sizeof(T); ++k) into.push_back(static_cast<std::uint8_t>(number >> (8 * k)));
}
void put(Bytes& into, ByteView bytes) { into.insert(into.end(), bytes.begin(), bytes.end()); }
void put_text(Bytes& into, std::string_view text) {
  put(into, static_cast<std::uint32_t>(text.size()));
  put(into, bytes_of(text));
}
void put(Bytes& into, const std::map<std::uint16_t, std::uint64_t>& numbers) {
  put(into, static_cast<std::uint32_t>(numbers.size() * 10));
  for (const auto& [key, value] : numbers) {
    put(into, key);
    put(into, value);
  }
}
void put(Bytes& into, const Span& times) {
  put(into, times.first_ns);
  put(into, times.last_ns);
}

Bytes record(Opcode opcode, ByteView content) {
  Bytes bytes;
  bytes.reserve(kPrefixBytes + content.size());
  put(bytes, static_cast<std::uint8_t>(opcode));
  put(bytes, std::uint64_t{content.size()});
  put(bytes, content);
  return bytes;
}

}  // namespace

Bytes header_record(std::string_view profile, std::string_view library) {
  Bytes content;
  put_text(content, profile);
  put_text(content, library);
  return record(Opcode::kHeader, content);
}

Bytes schema_record(std::uint16_t id, std::string_view name, std::string_view encoding,
                    std::string_view definition) {
  Bytes content;
  put(content, id);
  put_text(content, name);
  put_text(content, encoding);
  put_text(content, definition);
  return record(Opcode::kSchema, content);
}

Bytes channel_record(std::uint16_t id, std::uint16_t schema, std::string_view topic,
                     const std::map<std::string, std::string>& metadata) {
  Bytes pairs;
  for (const auto& [key, value] : metadata) {
    put_text(pairs, key);
    put_text(pairs, value);
  }
  Bytes content;
  put(content, id);
  put(content, schema);
  put_text(content, topic);
  put_text(content, "cdr");
  put(content, static_cast<std::uint32_t>(pairs.size()));
  put(content, pairs);
  return record(Opcode::kChannel, content);
}

void append_message(Bytes& records, std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                    ByteView data) {
  put(records, static_cast<std::uint8_t>(Opcode::kMessage));
  put(records, std::uint64_t{kTimesBytes + data.size()});
  put(records, channel);
  put(records, sequence);
  put(records, time_ns);
  put(records, time_ns);  // of publication, which is unknown
  put(records, data);
}

Bytes chunk_record(const Span& times, ByteView unpacked, std::string_view compression, ByteView packed) {
  Bytes content;
  content.reserve(64 + packed.size());
  put(content, times);
  put(content, std::uint64_t{unpacked.size()});
  put(content, static_cast<std::uint32_t>(crc32_z(0, unpacked.data(), unpacked.size())));
  put_text(content, compression);
  put(content, std::uint64_t{packed.size()});
  put(content, packed);
  return record(Opcode::kChunk, content);
}

Bytes message_index_record(std::uint16_t channel, const MessageIndex& index) {
  Bytes content;
  put(content, channel);
  put(content, static_cast<std::uint32_t>(index.size() * 16));
  for (const auto& [time, offset] : index) {
    put(content, time);
    put(content, offset);
  }
  return record(Opcode::kMessageIndex, content);
}

Bytes chunk_index_record(const ChunkIndex& index) {
  Bytes content;
  put(content, index.times);
  put(content, index.start);
  put(content, index.length);
  put(content, index.message_indexes);
  put(content, index.indexes_length);
  put_text(content, index.compression);
  put(content, index.packed_bytes);
  put(content, index.unpacked_bytes);
  return record(Opcode::kChunkIndex, content);
}

Bytes statistics_record(const Statistics& statistics) {
  Bytes content;
  put(content, statistics.messages);
  put(content, statistics.schemas);
  put(content, statistics.channels);
  put(content, std::uint32_t{0});  // attachments
  put(content, std::uint32_t{0});  // metadata
  put(content, statistics.chunks);
  put(content, statistics.times);
  put(content, statistics.channel_messages);
  return record(Opcode::kStatistics, content);
}

Bytes summary_offset_record(Opcode group, std::uint64_t start, std::uint64_t length) {
  Bytes content;
  put(content, static_cast<std::uint8_t>(group));
  put(content, start);
  put(content, length);
  return record(Opcode::kSummaryOffset, content);
}

Bytes data_end_record(std::uint32_t crc) {
  Bytes content;
  put(content, crc);
  return record(Opcode::kDataEnd, content);
}

Bytes footer_record(std::uint64_t summary, std::uint64_t summary_offsets, std::uint32_t crc) {
  Bytes content;
  put(content, summary);
  put(content, summary_offsets);
  put(content, std::uint32_t{0});
  Bytes bytes = record(Opcode::kFooter, content);
  bytes.resize(bytes.size() - sizeof crc);
  // The checksum covers this record, too, up to the checksum itself.
  put(bytes, static_cast<std::uint32_t>(crc32_z(crc, bytes.data(), bytes.size())));
  return bytes;
}

}  // namespace fleetmap::recording::mcap
