#include "chunked_file.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace fleetmap::recording {
namespace {

/// Messages are held back until no chunk that comes later can hold an earlier one, up to this many bytes.
constexpr std::size_t kMaxHeldBytes = 256u << 20;
constexpr std::size_t kBytesPerMessage = 100;  // of the queue itself

}  // namespace

Result<std::optional<BagMessage>> ChunkedFile::next() {
  current_ = {};
  while (true) {
    const bool room = block_bytes_ + kBytesPerMessage * held_.size() < kMaxHeldBytes;
    const bool may_come_first =
        next_ < found_.size() && (held_.empty() || (found_[next_].start <= held_.begin()->first && room));
    if (may_come_first) {
      Status status = load(found_[next_++]);
      if (status) continue;
      next_ = found_.size();
      held_.clear();
      return tl::unexpected(status.error());
    }
    if (held_.empty()) return std::optional<BagMessage>();
    auto first = held_.extract(held_.begin());
    current_ = std::move(first.mapped());
    if (const auto topic = topics_.find(current_.connection); topic != topics_.end())
      return BagMessage{topic->second.name, static_cast<std::int64_t>(first.key()),
                        cdr_of(topic->second, current_.data)};
    leave_out("a message of a topic that is named nowhere");
  }
}

Result<std::vector<BagTopic>> ChunkedFile::topics() {
  if (!topics_are_named()) {
    if (Status status = load_once(); !status) return tl::unexpected(status.error());
  }
  std::vector<BagTopic> topics;
  for (const auto& [connection, topic] : topics_) topics.push_back(topic);
  return topics;
}

void ChunkedFile::name_topic(std::uint32_t connection, BagTopic topic) {
  topics_.insert_or_assign(connection, std::move(topic));
}

void ChunkedFile::sort_found() { std::ranges::stable_sort(found_, {}, &Found::start); }

/// Loads all, for what it says of topics, and forgets the messages.
Status ChunkedFile::load_once() {
  for (const Found& found : found_) {
    if (Status status = load(found); !status) return status;
    held_.clear();
  }
  damaged_ = 0;
  return {};
}

std::shared_ptr<const Bytes> ChunkedFile::block_of(Bytes bytes) {
  block_bytes_ += bytes.size();
  return {new Bytes(std::move(bytes)), [this](const Bytes* block) {
            block_bytes_ -= block->size();
            delete block;
          }};
}

void ChunkedFile::hold(std::shared_ptr<const Bytes> block, std::uint64_t time, std::uint32_t connection,
                       ByteView data) {
  if (time > std::numeric_limits<std::int64_t>::max())
    return leave_out("a message of the year 2262 or later");
  held_.emplace(time, Held{std::move(block), connection, data});
}

Result<Bytes> ChunkedFile::read(std::uint64_t at, std::uint64_t count) {
  Bytes bytes(count);
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(at));
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (!stream_) return failure(file_.string() + ": cannot be read at byte " + std::to_string(at));
  return bytes;
}

void ChunkedFile::leave_out(const std::string& why) {
  if (damaged_++ == 0) first_damage_ = why + "; it is left out, as will be others";
}

void ChunkedFile::note_cut(std::uint64_t at, const char* remedy) {
  cut_ = "its end is missing, " + std::to_string(size_ - at) +
         " bytes of a record that was cut are left out; " + remedy;
}

std::string ChunkedFile::damage() const {
  if (damaged_parts() == 0) return {};
  const char* between = damaged_ == 0 || cut_.empty() ? "" : "; ";
  return file_.filename().string().append(": ").append(cut_).append(between).append(
      damaged_ == 0 ? "" : first_damage_);
}

}  // namespace fleetmap::recording
