#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

/// The records of an MCAP file (mcap.dev, specification 0) that reading messages needs.
namespace fleetmap::recording::mcap {

inline constexpr std::uint8_t kMagic[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

inline constexpr std::size_t kPrefixBytes = 9;    ///< opcode, length of the content
inline constexpr std::uint64_t kTimesBytes = 22;  ///< of content, in which the times stand
inline constexpr std::size_t kFooterBytes = 20;   ///< of content

struct Prefix {
  Opcode opcode{};
  std::uint64_t length = 0;  ///< of the content
};
struct Schema {
  std::uint16_t id = 0;
  std::string name;  ///< "sensor_msgs/msg/Imu"
};
struct Channel {
  std::uint16_t id = 0, schema = 0;
  std::string topic, encoding;  ///< "/imu", "cdr"
};
struct Message {
  std::uint16_t channel = 0;
  std::uint64_t log_time = 0;  ///< ns since the Unix epoch
  ByteView data;               ///< of the content that was read
};
struct Chunk {
  std::uint64_t start = 0;  ///< ns, the earliest log time
  std::uint64_t unpacked_bytes = 0;
  std::uint32_t crc = 0;    ///< of the unpacked records; 0: none
  std::string compression;  ///< "", "lz4" or "zstd"
  ByteView records;
};

/// The first 9 bytes of a record.
Prefix read_prefix(ByteView bytes);
/// Read a record's content; empty if it is shorter than what it claims to hold.
std::optional<Schema> read_schema(ByteView content);
std::optional<Channel> read_channel(ByteView content);
std::optional<Message> read_message(ByteView content);
std::optional<Chunk> read_chunk(ByteView content);
/// The earliest time (ns) in a message or chunk, from the first kTimesBytes of its content; 0 if there are
/// fewer.
std::uint64_t start_of(Opcode opcode, ByteView content);
/// Offset of the summary, or 0 for none.
std::optional<std::uint64_t> read_footer(ByteView content);

/// Unpacks the records of a chunk. Errors for an unknown compression, for damage, and for more than
/// `max_bytes`.
Result<Bytes> unpack_records(const Chunk& chunk, std::size_t max_bytes);

}  // namespace fleetmap::recording::mcap
