#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "draws.hpp"
#include "fleetmap/fault_injection/exchange_fleet.hpp"

namespace fleetmap::fault_injection {

/// Packets of a sender outside the fleet, and false packets of a robot of the fleet.
class Attacker {
 public:
  /// `signatures`: robots sign their items.
  Attacker(std::uint64_t seed, std::vector<AgentId> fleet, bool signatures);

  /// Every packet can be recorded.
  void overhear(const Packet& packet);

  struct Injected {
    AgentId to;
    messages::Reach reach;
    std::shared_ptr<const messages::Message> message;
  };
  /// A packet of a sender outside the fleet: with items of its own, or a recorded one.
  std::optional<Injected> stranger();
  /// In the name of a robot of the fleet: items with numbers of its, digests, chunks that nobody requested,
  /// damaged packets.
  std::optional<Injected> forged();
  /// A forged digest or an unrequested chunk, in the name of any robot.
  std::optional<Injected> forged_claim();
  /// The packet that the lying robot `liar` sends instead.
  messages::Message lie(messages::Message message, const AgentId& liar);

 private:
  const AgentId& anyone() { return fleet_[draws_.below(fleet_.size())]; }
  NodeId any_id();
  messages::Message forged_item();
  messages::Message forged_digest();
  /// The first chunk of the largest submap whose node was overheard; none: no submap has several.
  std::optional<messages::Message> forged_chunk();
  messages::Message with_false_signature(messages::Message item);
  /// The signature of an overheard item, or none.
  std::optional<Signature> overheard_signature();
  std::optional<messages::Message> damaged();
  Injected to_anyone(messages::Message message, messages::Reach reach);

  Draws draws_;
  std::vector<AgentId> fleet_;
  bool signatures_;
  std::deque<messages::Outgoing> overheard_;
};

}  // namespace fleetmap::fault_injection
