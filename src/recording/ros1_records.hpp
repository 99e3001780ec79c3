#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

/// The records of a ROS 1 bag of format 2.0 (wiki.ros.org/Bags/Format/2.0) that reading messages needs.
namespace fleetmap::recording::ros1 {

inline constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

enum class Op : std::uint8_t { kMessage = 2, kBagHeader = 3, kIndex = 4, kChunk = 5, kConnection = 7 };

/// A record, whose header is a list of named fields.
struct Record {
  ByteView header, data;
};
/// The first record of some bytes, which then begin behind it; empty if it is not all there.
std::optional<Record> take_record(ByteView& bytes);
/// A field of a record's header; empty if there is none.
ByteView field(const Record& record, std::string_view name);
Op op(const Record& record);

struct Connection {
  std::uint32_t id = 0;
  std::string topic, type;  ///< "/imu/data", "sensor_msgs/Imu"
};
std::optional<Connection> read_connection(const Record& record);

struct Message {
  std::uint32_t connection = 0;
  std::uint64_t time = 0;  ///< ns since the Unix epoch
};
std::optional<Message> read_message(const Record& record);

/// The earliest time (ns) of an index of a chunk.
std::optional<std::uint64_t> earliest(const Record& index);

/// Unpacks the records of a chunk. Errors for an unknown compression, damage, and more than `max_bytes`.
Result<Bytes> unpack_records(const Record& chunk, std::size_t max_bytes);

}  // namespace fleetmap::recording::ros1
