#include "mcap_file.hpp"

#include <algorithm>
#include <map>

#include "chunked_file.hpp"
#include "mcap_records.hpp"
#include "ros_names.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;
using mcap::Opcode;

class McapFile : public ChunkedFile {
 public:
  McapFile(fs::path file, std::ifstream stream, std::uint64_t size)
      : ChunkedFile(std::move(file), std::move(stream), size) {}

  /// Finds all records, without reading messages.
  Status index();

 private:
  Status load(const Found& found) override;
  bool topics_are_named() override { return read_summary(); }
  ByteView cdr_of(const BagTopic&, ByteView data) override { return data; }
  Status note_record(Opcode opcode, std::uint64_t content, std::uint64_t length);
  void note(Opcode opcode, ByteView content);
  bool read_summary();
  void hold_messages(const std::shared_ptr<const Bytes>& records);

  std::map<std::uint16_t, std::string> types_;  ///< by schema
};

void McapFile::note(Opcode opcode, ByteView content) {
  if (opcode == Opcode::kSchema) {
    if (auto schema = mcap::read_schema(content))
      types_.insert_or_assign(schema->id, std::move(schema->name));
  } else if (opcode == Opcode::kChannel) {
    const auto channel = mcap::read_channel(content);
    if (!channel) return;
    const auto type = types_.find(channel->schema);
    std::string name = type == types_.end() ? "" : ros_type(type->second);
    if (channel->encoding != "cdr") name += " in " + channel->encoding;  // so that none is chosen
    name_topic(channel->id, BagTopic{ros_topic(channel->topic), std::move(name)});
  }
}

/// Remembers where messages lie, and what names their topics.
Status McapFile::note_record(Opcode opcode, std::uint64_t content, std::uint64_t length) {
  const bool messages = opcode == Opcode::kChunk || opcode == Opcode::kMessage;
  if (!messages && opcode != Opcode::kSchema && opcode != Opcode::kChannel) return {};
  if (length > kMaxRecordBytes) {
    leave_out("a record of " + std::to_string(length) + " bytes at byte " + std::to_string(content));
    return {};
  }
  const auto bytes = read(content, messages ? std::min(length, mcap::kTimesBytes) : length);
  if (!bytes) return tl::unexpected(bytes.error());
  if (messages) {
    found_.push_back({content, length, mcap::start_of(opcode, *bytes), opcode == Opcode::kChunk});
  } else {
    note(opcode, *bytes);
  }
  return {};
}

Status McapFile::index() {
  std::uint64_t at = std::size(mcap::kMagic);
  bool closed = false;
  while (!closed && at + mcap::kPrefixBytes <= size()) {
    const auto bytes = read(at, mcap::kPrefixBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto [opcode, length] = mcap::read_prefix(*bytes);
    closed = opcode == Opcode::kFooter;
    const std::uint64_t content = at + mcap::kPrefixBytes;
    if (closed || length > size() - content) break;
    if (Status status = note_record(opcode, content, length); !status) return status;
    at = content + length;
  }
  if (!closed) note_cut(at, "`mcap recover` gives a whole file");
  sort_found();
  return {};
}

void McapFile::hold_messages(const std::shared_ptr<const Bytes>& records) {
  ByteView rest = *records;
  while (rest.size() >= mcap::kPrefixBytes) {
    const auto [opcode, length] = mcap::read_prefix(rest);
    rest = rest.subspan(mcap::kPrefixBytes);
    if (length > rest.size()) break;
    const ByteView content = rest.first(length);
    rest = rest.subspan(length);
    note(opcode, content);
    if (opcode != Opcode::kMessage) continue;
    if (const auto message = mcap::read_message(content))
      hold(records, message->log_time, message->channel, message->data);
  }
  if (!rest.empty()) leave_out("a chunk ends within a record");
}

Status McapFile::load(const Found& found) {
  auto content = read(found.at, found.length);
  if (!content) return tl::unexpected(content.error());
  const auto block = block_of(std::move(*content));
  const std::string where = " at byte " + std::to_string(found.at);
  if (!found.chunk) {
    if (const auto message = mcap::read_message(*block)) {
      hold(block, message->log_time, message->channel, message->data);
    } else {
      leave_out("a damaged message" + where);
    }
    return {};
  }
  const auto chunk = mcap::read_chunk(*block);
  if (!chunk) {
    leave_out("a damaged chunk" + where);
    return {};
  }
  auto records = mcap::unpack_records(*chunk, kMaxRecordBytes);
  if (records) {
    hold_messages(block_of(std::move(*records)));
  } else {
    leave_out("the chunk" + where + ": " + records.error().message);
  }
  return {};
}

/// The summary at the end of a file that was closed repeats schemas and channels. False if it has none.
bool McapFile::read_summary() {
  constexpr std::uint64_t kEnd = mcap::kPrefixBytes + mcap::kFooterBytes + std::size(mcap::kMagic);
  if (size() < kEnd + std::size(mcap::kMagic)) return false;
  const auto end = read(size() - kEnd, kEnd);
  if (!end || !std::ranges::equal(ByteView(*end).last(std::size(mcap::kMagic)), mcap::kMagic)) return false;
  const auto [opcode, length] = mcap::read_prefix(*end);
  if (opcode != Opcode::kFooter || length != mcap::kFooterBytes) return false;
  const auto start = mcap::read_footer(ByteView(*end).subspan(mcap::kPrefixBytes, mcap::kFooterBytes));
  const std::uint64_t footer = size() - kEnd;
  if (!start || *start == 0 || *start >= footer || footer - *start > kMaxRecordBytes) return false;
  const auto summary = read(*start, footer - *start);
  if (!summary) return false;
  for (ByteView rest = *summary; rest.size() >= mcap::kPrefixBytes;) {
    const auto [opcode_of, length_of] = mcap::read_prefix(rest);
    rest = rest.subspan(mcap::kPrefixBytes);
    if (length_of > rest.size()) return false;
    note(opcode_of, rest.first(length_of));
    rest = rest.subspan(length_of);
  }
  // Types may be left out of it.
  return !named().empty() &&
         std::ranges::none_of(named(), [](const auto& channel) { return channel.second.type.empty(); });
}

}  // namespace

Result<std::unique_ptr<BagFile>> open_mcap_file(const fs::path& file) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) return failure(file.string() + ": cannot be read");
  char magic[std::size(mcap::kMagic)] = {};
  stream.read(magic, sizeof magic);
  const auto same = [](char read, std::uint8_t right) { return static_cast<std::uint8_t>(read) == right; };
  if (!stream || !std::ranges::equal(magic, mcap::kMagic, same))
    return failure(file.string() + ": this is no mcap file of version 0");
  auto mcap = std::make_unique<McapFile>(file, std::move(stream), size);
  if (Status status = mcap->index(); !status) return tl::unexpected(status.error());
  return mcap;
}

}  // namespace fleetmap::recording
