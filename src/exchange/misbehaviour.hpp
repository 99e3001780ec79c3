#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/exchange/exchange_events.hpp"

namespace fleetmap::exchange {

/// Counts the messages that contradict the rules or bear another robot's name, by the robot that sent them.
/// Messages other than items bear no signatures, so this names the sender by the link where the link
/// identifies it.
class Misbehaviour {
 public:
  /// True the first time that this robot does so, for the first 64 such cases.
  bool add(const AgentId& robot, SenderMisbehaved::Kind kind) {
    constexpr std::size_t kMaxReported = 64;
    const bool is_new = reported_.size() < kMaxReported && reported_.insert({robot, kind}).second;
    if (const auto known = messages_.find(robot); known != messages_.end()) {
      ++known->second;
    } else if (messages_.size() < kMaxReported) {
      messages_.emplace(robot, 1);
    }
    return is_new;
  }
  const std::map<AgentId, std::uint64_t>& messages() const { return messages_; }

 private:
  std::set<std::pair<AgentId, SenderMisbehaved::Kind>> reported_;
  std::map<AgentId, std::uint64_t> messages_;
};

}  // namespace fleetmap::exchange
