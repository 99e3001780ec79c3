#pragma once

#include <map>
#include <optional>
#include <string>

#include "protocol.hpp"

namespace fleetmap::monitor::foxglove {

/// Subscriptions of one client: at most one a channel.
///
/// A channel's newest message is due once after each revision. A message that was not sent before the next
/// one came is never sent, so nothing queues up for a slow client.
class Subscriptions {
 public:
  /// Follows a client's request as far as it can be followed; returns what is wrong with the rest, else
  /// empty. `channels` are all that exist; their ids are 1, 2, ...
  std::string apply(const ClientRequest& request, std::span<const Channel> channels);
  /// The next message to send: channels take turns. It counts as sent.
  std::optional<Subscription> next_due(std::span<const Channel> channels);
  bool has(std::uint32_t channel) const { return by_channel_.contains(channel); }

 private:
  std::string subscribe(const Subscription& wanted, std::span<const Channel> channels);
  std::string unsubscribe(std::uint32_t id);

  struct Entry {
    std::uint32_t id = 0;
    std::uint64_t sent_revision = 0;
  };
  std::map<std::uint32_t, Entry> by_channel_;
  std::uint32_t last_ = 0;  ///< channel that was due last
};

}  // namespace fleetmap::monitor::foxglove
