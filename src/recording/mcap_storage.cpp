#include "mcap_storage.hpp"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "fleetmap/ros_codec/message_definitions.hpp"
#include "mcap_encoding.hpp"
#include "pack.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;
using mcap::Opcode;

constexpr std::size_t kMaxIds = 65'535;  // channels and schemas are numbered with 16 bits

void extend(std::optional<mcap::Span>& times, std::uint64_t ns) {
  if (!times) times = mcap::Span{ns, ns};
  times->first_ns = std::min(times->first_ns, ns);
  times->last_ns = std::max(times->last_ns, ns);
}

class McapStorage : public StorageFile {
 public:
  McapStorage(fs::path file, std::ofstream stream, ChunkCompression compression)
      : file_(std::move(file)), stream_(std::move(stream)), compression_(compression) {}

  Status begin();
  Status add_topic(const WrittenTopic& topic) override;
  Status write(std::size_t topic, std::int64_t received_ns, ByteView cdr) override;
  Status flush() override;
  Status close() override;

 private:
  Status append(ByteView bytes);
  /// Ends the recording: nothing more is kept in memory for a file that takes nothing.
  tl::unexpected<Error> stop();
  Result<std::uint16_t> schema_of(const std::string& type);
  Result<Bytes> packed() const;
  std::string_view compression_name() const;
  Status append_summary();

  fs::path file_;
  std::ofstream stream_;
  ChunkCompression compression_;
  bool stopped_ = false;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  ///< of all that was appended to the current section

  std::map<std::string, std::uint16_t> schemas_;  ///< by type
  Bytes schema_records_, channel_records_;        ///< which the summary repeats
  mcap::Statistics statistics_;
  std::optional<mcap::Span> times_;
  std::vector<mcap::ChunkIndex> chunks_;

  Bytes chunk_;  ///< the records of the next chunk
  std::optional<mcap::Span> chunk_times_;
  std::map<std::uint16_t, mcap::MessageIndex> chunk_messages_;
};

tl::unexpected<Error> McapStorage::stop() {
  stopped_ = true;
  chunk_ = {};
  chunk_times_.reset();
  chunk_messages_.clear();
  return failure(file_.string() + ": cannot be written; is the disk full?");
}

Status McapStorage::append(ByteView bytes) {
  stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) return stop();
  crc_ = static_cast<std::uint32_t>(crc32_z(crc_, bytes.data(), bytes.size()));
  size_ += bytes.size();
  return {};
}

Status McapStorage::begin() {
  if (Status status = append(mcap::kMagic); !status) return status;
  return append(mcap::header_record("ros2", "fleetmap"));
}

Result<std::uint16_t> McapStorage::schema_of(const std::string& type) {
  if (const auto known = schemas_.find(type); known != schemas_.end()) return known->second;
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);  // 0 stands for none
  const std::string definition = ros_codec::message_definition(type);
  const Bytes record = mcap::schema_record(id, type, definition.empty() ? "" : "ros2msg", definition);
  if (Status status = append(record); !status) return tl::unexpected(status.error());
  schema_records_.insert(schema_records_.end(), record.begin(), record.end());
  schemas_.emplace(type, id);
  return id;
}

/// Schemas and channels are outside of chunks, so that a damaged chunk costs its own messages alone.
Status McapStorage::add_topic(const WrittenTopic& topic) {
  if (statistics_.channels == kMaxIds) return failure(file_.string() + ": an MCAP file has no more channels");
  const auto schema = schema_of(topic.type);
  if (!schema) return tl::unexpected(schema.error());
  const auto id = static_cast<std::uint16_t>(statistics_.channels++);
  const Bytes record =
      mcap::channel_record(id, *schema, topic.name, {{"offered_qos_profiles", topic.offered_qos}});
  if (Status status = append(record); !status) return status;
  channel_records_.insert(channel_records_.end(), record.begin(), record.end());
  statistics_.channel_messages[id] = 0;
  return {};
}

Status McapStorage::write(std::size_t topic, std::int64_t received_ns, ByteView cdr) {
  if (stopped_) return stop();
  const auto channel = static_cast<std::uint16_t>(topic);
  const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(received_ns, 0));
  const auto sequence = static_cast<std::uint32_t>(++statistics_.channel_messages[channel]);
  chunk_messages_[channel].emplace_back(time, chunk_.size());
  mcap::append_message(chunk_, channel, sequence, time, cdr);
  extend(chunk_times_, time);
  extend(times_, time);
  ++statistics_.messages;
  return {};
}

std::string_view McapStorage::compression_name() const {
  switch (compression_) {
    case ChunkCompression::kZstd:
      return "zstd";
    case ChunkCompression::kLz4:
      return "lz4";
    default:
      return "";
  }
}

Result<Bytes> McapStorage::packed() const {
  switch (compression_) {
    case ChunkCompression::kZstd:
      return pack_zstd(chunk_);
    case ChunkCompression::kLz4:
      return pack_lz4(chunk_);
    default:
      return chunk_;
  }
}

/// Ends the chunk, and hands it to the operating system.
Status McapStorage::flush() {
  if (chunk_times_) {
    const auto packed = this->packed();
    if (!packed) return failure(file_.string() + ": " + packed.error().message);
    mcap::ChunkIndex index;
    index.times = *chunk_times_;
    index.start = size_;
    index.compression = compression_name();
    index.packed_bytes = packed->size();
    index.unpacked_bytes = chunk_.size();
    if (Status status = append(mcap::chunk_record(*chunk_times_, chunk_, index.compression, *packed));
        !status)
      return status;
    index.length = size_ - index.start;
    for (const auto& [channel, messages] : chunk_messages_) {
      index.message_indexes[channel] = size_;
      if (Status status = append(mcap::message_index_record(channel, messages)); !status) return status;
    }
    index.indexes_length = size_ - index.start - index.length;
    chunks_.push_back(std::move(index));
    chunk_.clear();
    chunk_times_.reset();
    chunk_messages_.clear();
  }
  stream_.flush();
  if (!stream_) return stop();
  return {};
}

Status McapStorage::append_summary() {
  statistics_.schemas = static_cast<std::uint16_t>(schemas_.size());
  statistics_.chunks = static_cast<std::uint32_t>(chunks_.size());
  statistics_.times = times_.value_or(mcap::Span{});
  Bytes chunk_records;
  for (const mcap::ChunkIndex& chunk : chunks_) {
    const Bytes record = mcap::chunk_index_record(chunk);
    chunk_records.insert(chunk_records.end(), record.begin(), record.end());
  }
  const Bytes statistics = mcap::statistics_record(statistics_);
  const std::pair<Opcode, std::reference_wrapper<const Bytes>> groups[] = {
      {Opcode::kSchema, schema_records_},
      {Opcode::kChannel, channel_records_},
      {Opcode::kStatistics, statistics},
      {Opcode::kChunkIndex, chunk_records}};
  const std::uint64_t start = size_;
  Bytes offsets;
  for (const auto& [opcode, records] : groups) {
    if (records.get().empty()) continue;
    const Bytes offset = mcap::summary_offset_record(opcode, size_, records.get().size());
    offsets.insert(offsets.end(), offset.begin(), offset.end());
    if (Status status = append(records.get()); !status) return status;
  }
  const std::uint64_t offsets_start = size_;
  if (Status status = append(offsets); !status) return status;
  return append(mcap::footer_record(start, offsets_start, crc_));
}

Status McapStorage::close() {
  if (Status status = flush(); !status) return status;
  if (Status status = append(mcap::data_end_record(crc_)); !status) return status;
  crc_ = 0;
  if (Status status = append_summary(); !status) return status;
  if (Status status = append(mcap::kMagic); !status) return status;
  stream_.close();
  if (!stream_) return stop();
  return {};
}

}  // namespace

Result<std::unique_ptr<StorageFile>> create_mcap_storage(const fs::path& file, ChunkCompression compression) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!stream) return failure(file.string() + ": cannot be written");
  auto storage = std::make_unique<McapStorage>(file, std::move(stream), compression);
  if (Status status = storage->begin(); !status) return tl::unexpected(status.error());
  return storage;
}

}  // namespace fleetmap::recording
