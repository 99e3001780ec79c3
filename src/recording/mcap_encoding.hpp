#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "mcap_records.hpp"

/// Whole records of an MCAP file (mcap.dev, specification 0), as bytes.
namespace fleetmap::recording::mcap {

/// Messages of one channel within a chunk: log time (ns) and offset in the unpacked records.
using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

struct Span {
  std::uint64_t first_ns = 0, last_ns = 0;  ///< earliest and latest log time
};
/// Place of a chunk and of its message indexes in the file.
struct ChunkIndex {
  Span times;
  std::uint64_t start = 0;                                 ///< offset of the chunk's record
  std::uint64_t length = 0;                                ///< of the whole record
  std::map<std::uint16_t, std::uint64_t> message_indexes;  ///< offset of the record, by channel
  std::uint64_t indexes_length = 0;                        ///< of all these records
  std::string compression;
  std::uint64_t packed_bytes = 0, unpacked_bytes = 0;
};
struct Statistics {
  std::uint64_t messages = 0;
  std::uint16_t schemas = 0;
  std::uint32_t channels = 0, chunks = 0;
  Span times;
  std::map<std::uint16_t, std::uint64_t> channel_messages;
};

Bytes header_record(std::string_view profile, std::string_view library);
/// `encoding` and `definition` are empty where the type's definition is unknown.
Bytes schema_record(std::uint16_t id, std::string_view name, std::string_view encoding,
                    std::string_view definition);
Bytes channel_record(std::uint16_t id, std::uint16_t schema, std::string_view topic,
                     const std::map<std::string, std::string>& metadata);
void append_message(Bytes& records, std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                    ByteView data);
/// `unpacked` are the records of which `packed` is the compressed form.
Bytes chunk_record(const Span& times, ByteView unpacked, std::string_view compression, ByteView packed);
Bytes message_index_record(std::uint16_t channel, const MessageIndex& index);
Bytes chunk_index_record(const ChunkIndex& index);
Bytes statistics_record(const Statistics& statistics);
Bytes summary_offset_record(Opcode group, std::uint64_t start, std::uint64_t length);
Bytes data_end_record(std::uint32_t crc);
/// `crc`: of the summary section and its offsets, before this record.
Bytes footer_record(std::uint64_t summary, std::uint64_t summary_offsets, std::uint32_t crc);

}  // namespace fleetmap::recording::mcap
