#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "fleetmap/bus/bus.hpp"

namespace fleetmap::bus {

/// Messages of one topic between Fast DDS's threads, which put, and the callback thread, which takes. Bounded
/// in messages and bytes; the oldest is dropped and counted.
class Inbox {
 public:
  /// A participant's RTPS prefix; zeros: unknown.
  using Sender = std::array<std::uint8_t, 12>;
  struct Message {
    Bytes cdr;
    Sender sender{};
  };

  Inbox(std::size_t max_messages, std::size_t max_bytes)
      : max_messages_(max_messages), max_bytes_(max_bytes) {}

  /// True if a dispatch is to be posted: fewer wait than messages. One that takes the place of an older
  /// message is taken by that one's, so no flood makes more callbacks wait than the inbox holds messages.
  [[nodiscard]] bool put(Bytes cdr, const Sender& sender = {}) {
    const std::scoped_lock lock(mutex_);
    bytes_ += cdr.size();
    messages_.push_back({std::move(cdr), sender});
    while (messages_.size() > max_messages_ || (bytes_ > max_bytes_ && messages_.size() > 1)) {
      bytes_ -= messages_.front().cdr.size();
      messages_.pop_front();
      ++dropped_;
    }
    if (dispatches_ >= messages_.size()) return false;
    ++dispatches_;
    return true;
  }
  /// For a dispatch.
  std::optional<Message> take() {
    const std::scoped_lock lock(mutex_);
    if (dispatches_ > 0) --dispatches_;
    if (messages_.empty()) return std::nullopt;
    std::optional<Message> oldest(std::move(messages_.front()));
    messages_.pop_front();
    bytes_ -= oldest->cdr.size();
    ++taken_messages_;
    taken_bytes_ += oldest->cdr.size();
    return oldest;
  }
  void add_to(TopicStats& stats) const {
    const std::scoped_lock lock(mutex_);
    stats.received_messages += taken_messages_;
    stats.received_bytes += taken_bytes_;
    stats.dropped_messages += dropped_;
  }

 private:
  const std::size_t max_messages_;
  const std::size_t max_bytes_;
  mutable std::mutex mutex_;  ///< guards all below
  std::deque<Message> messages_;
  std::size_t bytes_ = 0;
  std::size_t dispatches_ = 0;  ///< posted and not run
  std::uint64_t dropped_ = 0;
  std::uint64_t taken_messages_ = 0;
  std::uint64_t taken_bytes_ = 0;
};

}  // namespace fleetmap::bus
