#include "mcap_file.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <utility>

#include "mcap_records.hpp"
#include "ros_names.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;
using mcap::Opcode;

constexpr std::uint64_t kMaxRecordBytes = 256u << 20;  // writers make chunks of some MB
/// Messages are held back until no chunk that comes later can hold an earlier one, up to this many bytes.
constexpr std::size_t kMaxHeldBytes = 256u << 20;

class McapFile : public BagFile {
 public:
  McapFile(fs::path file, std::ifstream stream, std::uint64_t size)
      : file_(std::move(file)), stream_(std::move(stream)), size_(size) {}

  /// Finds all records, without reading messages.
  Status index();
  Result<std::vector<BagTopic>> topics() override;
  Result<std::optional<BagMessage>> next() override;
  std::uint64_t damaged_parts() const override { return damaged_; }

 private:
  /// A message, or a chunk of them, that was found and not read yet.
  struct Found {
    Opcode opcode;
    std::uint64_t content;  ///< where it begins in the file
    std::uint64_t length;
    std::uint64_t start;  ///< ns, no message in it is earlier
  };
  /// A message that waits for its turn; its bytes are part of what `block` holds.
  struct Held {
    std::shared_ptr<const Bytes> block;
    mcap::Message message;
  };

  Result<Bytes> read(std::uint64_t at, std::uint64_t count);
  Status note_record(Opcode opcode, std::uint64_t content, std::uint64_t length);
  void note(Opcode opcode, ByteView content);
  bool read_summary();
  Status load(const Found& found);
  void hold_messages(const std::shared_ptr<const Bytes>& records);
  void hold(std::shared_ptr<const Bytes> block, const mcap::Message& message);
  void leave_out(const std::string& why);

  fs::path file_;
  std::ifstream stream_;
  std::uint64_t size_;
  std::vector<Found> found_;                    ///< in the order in which they begin
  std::size_t next_ = 0;                        ///< of found_
  std::map<std::uint16_t, std::string> types_;  ///< by schema
  std::map<std::uint16_t, mcap::Channel> channels_;
  std::multimap<std::uint64_t, Held> held_;  ///< by time of recording, equal ones as they lie in the file
  std::size_t held_bytes_ = 0;
  Held given_;
  std::uint64_t damaged_ = 0;
};

Result<Bytes> McapFile::read(std::uint64_t at, std::uint64_t count) {
  Bytes bytes(count);
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(at));
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!stream_) return failure(file_.string() + ": cannot be read at byte " + std::to_string(at));
  return bytes;
}

void McapFile::leave_out(const std::string& why) {
  if (damaged_++ == 0) spdlog::warn("{}: {}; it is left out, as will be others", file_.string(), why);
}

void McapFile::note(Opcode opcode, ByteView content) {
  if (opcode == Opcode::kSchema) {
    if (auto schema = mcap::read_schema(content))
      types_.insert_or_assign(schema->id, std::move(schema->name));
  } else if (opcode == Opcode::kChannel) {
    if (auto channel = mcap::read_channel(content))
      channels_.insert_or_assign(channel->id, std::move(*channel));
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
    found_.push_back({opcode, content, length, mcap::start_of(opcode, *bytes)});
  } else {
    note(opcode, *bytes);
  }
  return {};
}

Status McapFile::index() {
  std::uint64_t at = std::size(mcap::kMagic);
  while (at + mcap::kPrefixBytes <= size_) {
    const auto bytes = read(at, mcap::kPrefixBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto [opcode, length] = mcap::read_prefix(*bytes);
    if (opcode == Opcode::kFooter) break;
    const std::uint64_t content = at + mcap::kPrefixBytes;
    if (length > size_ - content) {
      spdlog::warn("{}: cut within its last record, {} bytes are left out; `mcap recover` gives a whole file",
                   file_.string(), size_ - at);
      break;
    }
    if (Status status = note_record(opcode, content, length); !status) return status;
    at = content + length;
  }
  std::ranges::stable_sort(found_, {}, &Found::start);
  return {};
}

void McapFile::hold(std::shared_ptr<const Bytes> block, const mcap::Message& message) {
  held_bytes_ += message.data.size();
  held_.emplace(message.log_time, Held{std::move(block), message});
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
    if (const auto message = mcap::read_message(content)) hold(records, *message);
  }
  if (!rest.empty()) leave_out("a chunk ends within a record");
}

/// Damage is left out; an error means that the file cannot be read at all.
Status McapFile::load(const Found& found) {
  auto content = read(found.content, found.length);
  if (!content) return tl::unexpected(content.error());
  const auto block = std::make_shared<const Bytes>(std::move(*content));
  const std::string where = " at byte " + std::to_string(found.content);
  if (found.opcode == Opcode::kMessage) {
    if (const auto message = mcap::read_message(*block)) {
      hold(block, *message);
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
    hold_messages(std::make_shared<const Bytes>(std::move(*records)));
  } else {
    leave_out("the chunk" + where + ": " + records.error().message);
  }
  return {};
}

Result<std::optional<BagMessage>> McapFile::next() {
  given_ = {};
  while (true) {
    const bool may_come_first =
        next_ < found_.size() &&
        (held_.empty() || (found_[next_].start <= held_.begin()->first && held_bytes_ < kMaxHeldBytes));
    if (may_come_first) {
      Status status = load(found_[next_++]);
      if (status) continue;
      next_ = found_.size();
      held_.clear();
      return tl::unexpected(status.error());
    }
    if (held_.empty()) return std::optional<BagMessage>();
    given_ = std::move(held_.begin()->second);
    held_.erase(held_.begin());
    held_bytes_ -= given_.message.data.size();
    const auto channel = channels_.find(given_.message.channel);
    if (channel == channels_.end()) continue;
    return BagMessage{ros_topic(channel->second.topic), static_cast<std::int64_t>(given_.message.log_time),
                      given_.message.data};
  }
}

/// The summary at the end of a file that was closed repeats schemas and channels. False if it has none.
bool McapFile::read_summary() {
  constexpr std::uint64_t kEnd = mcap::kPrefixBytes + mcap::kFooterBytes + std::size(mcap::kMagic);
  if (size_ < kEnd + std::size(mcap::kMagic)) return false;
  const auto end = read(size_ - kEnd, kEnd);
  if (!end || !std::ranges::equal(ByteView(*end).last(std::size(mcap::kMagic)), mcap::kMagic)) return false;
  const auto [opcode, length] = mcap::read_prefix(*end);
  if (opcode != Opcode::kFooter || length != mcap::kFooterBytes) return false;
  const auto start = mcap::read_footer(ByteView(*end).subspan(mcap::kPrefixBytes, mcap::kFooterBytes));
  const std::uint64_t footer = size_ - kEnd;
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
  return !channels_.empty();
}

Result<std::vector<BagTopic>> McapFile::topics() {
  // Without a summary, topics are named between the messages.
  if (!read_summary()) {
    for (const Found& found : found_) {
      if (Status status = load(found); !status) return tl::unexpected(status.error());
      held_.clear();
    }
    held_bytes_ = 0;
    damaged_ = 0;
  }
  std::vector<BagTopic> topics;
  for (const auto& [id, channel] : channels_) {
    const auto type = types_.find(channel.schema);
    std::string name = type == types_.end() ? "" : ros_type(type->second);
    if (channel.encoding != "cdr") name += " in " + channel.encoding;  // so that none is chosen
    topics.push_back({ros_topic(channel.topic), std::move(name)});
  }
  return topics;
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
