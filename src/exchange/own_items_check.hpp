#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/exchange/exchange_events.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::Digest;

/// Finds items under this robot's name that its store lacks in the digests of others: the store was lost or
/// restored, or another robot uses the name or the number of the running session.
class OwnItemsCheck {
 public:
  explicit OwnItemsCheck(const AgentId& self) : self_(self) {}

  void begin_session(std::uint16_t session) { session_ = session; }
  std::optional<std::uint16_t> session() const { return session_; }
  /// SessionTaken each time, OwnItemsElsewhere once.
  std::vector<Event> on_digest(const Digest& digest, const store::Store& store);

 private:
  bool names_beyond(const std::vector<SeqRange>& ranges, std::uint32_t next) const;
  std::uint64_t count_unknown(const std::vector<SeqRange>& ranges, const store::SeqSet& held) const;

  AgentId self_;
  std::optional<std::uint16_t> session_;
  bool reported_ = false;
};

}  // namespace fleetmap::exchange
