#include "ros1_file.hpp"

#include <algorithm>
#include <map>

#include "chunked_file.hpp"
#include "fleetmap/core/byte_fields.hpp"
#include "fleetmap/ros_codec/ros1.hpp"
#include "ros1_records.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;
using ros1::Op;

class Ros1File : public ChunkedFile {
 public:
  Ros1File(fs::path file, std::ifstream stream, std::uint64_t size)
      : ChunkedFile(std::move(file), std::move(stream), size) {}

  /// Finds all records, without reading messages.
  Status index();

 private:
  Status load(const Found& found) override;
  bool topics_are_named() override {
    // A bag that was closed repeats its connections at its end, unless that was cut off.
    return promised_ > 0 && repeated_ >= promised_;
  }
  ByteView cdr_of(const BagTopic& topic, ByteView data) override;
  Status note_record(std::uint64_t at, std::uint64_t header_bytes, std::uint64_t data_bytes);
  void note_connection(const ros1::Record& record);

  std::size_t indexed_ = 0;                    ///< found_ when an index came last
  std::uint32_t promised_ = 0, repeated_ = 0;  ///< connections at the end of the bag
  Bytes cdr_;
};

/// ROS 2 calls "sensor_msgs/Imu" "sensor_msgs/msg/Imu".
std::string ros2_type(std::string type) {
  if (const auto slash = type.find('/'); slash != std::string::npos) type.insert(slash, "/msg");
  return type;
}

void Ros1File::note_connection(const ros1::Record& record) {
  if (const auto connection = ros1::read_connection(record))
    name_topic(connection->id, BagTopic{connection->topic, ros2_type(connection->type)});
}

/// Remembers where messages lie, and what names their topics.
Status Ros1File::note_record(std::uint64_t at, std::uint64_t header_bytes, std::uint64_t data_bytes) {
  const std::uint64_t length = 8 + header_bytes + data_bytes;
  const auto header = read(at + 4, header_bytes);
  if (!header) return tl::unexpected(header.error());
  const Op op = ros1::op({*header, {}});
  if (op == Op::kBagHeader)
    promised_ = ByteFields(ros1::field({*header, {}}, "conn_count")).number<std::uint32_t>();
  if (op == Op::kChunk || op == Op::kMessage) {
    // A chunk's times stand in the indices behind it; without them it keeps its place.
    const std::uint64_t before = found_.empty() ? 0 : found_.back().start;
    found_.push_back({at, length, before, op == Op::kChunk});
    if (const auto message = ros1::read_message({*header, {}}); op == Op::kMessage && message)
      found_.back().start = message->time;
  } else if (op == Op::kConnection || (op == Op::kIndex && !found_.empty())) {
    if (length > kMaxRecordBytes) return {};
    const auto data = read(at + 8 + header_bytes, data_bytes);
    if (!data) return tl::unexpected(data.error());
    const ros1::Record record{*header, *data};
    if (op == Op::kConnection) {
      note_connection(record);
      ++repeated_;
    }
    if (const auto first = ros1::earliest(record); op == Op::kIndex && first) {
      // The first index of a chunk takes the place of the time before.
      Found& chunk = found_.back();
      chunk.start = indexed_ == found_.size() ? std::min(chunk.start, *first) : *first;
      indexed_ = found_.size();
    }
  }
  return {};
}

Status Ros1File::index() {
  constexpr const char* kRemedy = "`rosbag reindex` gives a whole file";
  std::uint64_t at = ros1::kMagic.size();
  while (at < size()) {
    if (size() - at < 8) {
      note_cut(at, kRemedy);
      break;
    }
    const auto head = read(at, 4);
    if (!head) return tl::unexpected(head.error());
    const auto header_bytes = ByteFields(*head).number<std::uint32_t>();
    if (header_bytes > kMaxRecordBytes || header_bytes > size() - at - 8) {
      note_cut(at, kRemedy);
      break;
    }
    const auto middle = read(at + 4 + header_bytes, 4);
    if (!middle) return tl::unexpected(middle.error());
    const auto data_bytes = ByteFields(*middle).number<std::uint32_t>();
    if (data_bytes > size() - at - 8 - header_bytes) {
      note_cut(at, kRemedy);
      break;
    }
    if (Status status = note_record(at, header_bytes, data_bytes); !status) return status;
    at += 8 + std::uint64_t{header_bytes} + data_bytes;
  }
  sort_found();
  return {};
}

/// Returns no bytes, from which no message decodes, if the message is damaged or of a type that is not read.
ByteView Ros1File::cdr_of(const BagTopic& topic, ByteView data) {
  auto cdr = ros_codec::cdr_from_ros1(topic.type, data);
  cdr_ = cdr ? std::move(*cdr) : Bytes();
  return cdr_;
}

Status Ros1File::load(const Found& found) {
  const std::string where = " at byte " + std::to_string(found.at);
  if (found.length > kMaxRecordBytes) {
    leave_out("a record of " + std::to_string(found.length) + " bytes" + where);
    return {};
  }
  auto bytes = read(found.at, found.length);
  if (!bytes) return tl::unexpected(bytes.error());
  auto block = block_of(std::move(*bytes));
  ByteView rest = *block;
  if (found.chunk) {
    const auto chunk = ros1::take_record(rest);
    auto records = chunk ? ros1::unpack_records(*chunk, kMaxRecordBytes) : failure("is cut");
    if (!records) {
      leave_out("the chunk" + where + ": " + records.error().message);
      return {};
    }
    block = block_of(std::move(*records));
    rest = *block;
  }
  while (const auto record = ros1::take_record(rest)) {
    if (ros1::op(*record) == Op::kConnection) note_connection(*record);
    if (ros1::op(*record) != Op::kMessage) continue;
    if (const auto message = ros1::read_message(*record))
      hold(block, message->time, message->connection, record->data);
  }
  if (!rest.empty()) leave_out("a chunk" + where + " ends within a record");
  return {};
}

}  // namespace

Result<std::unique_ptr<BagFile>> open_ros1_file(const fs::path& file) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) return failure(file.string() + ": cannot be read");
  std::string magic(ros1::kMagic.size(), '\0');
  stream.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (!stream || magic != ros1::kMagic)
    return failure(file.string() + ": this is no ROS 1 bag of format 2.0; `rosbag fix` converts older ones");
  auto bag = std::make_unique<Ros1File>(file, std::move(stream), size);
  if (Status status = bag->index(); !status) return tl::unexpected(status.error());
  return bag;
}

}  // namespace fleetmap::recording
