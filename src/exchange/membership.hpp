#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::exchange {

/// The robots of the fleet. Messages and items of any other robot are refused and counted.
class Membership {
 public:
  Membership(const AgentId& self, std::span<const AgentId> fleet)
      : self_(self), fleet_(fleet.begin(), fleet.end()) {}

  const AgentId& self() const { return self_; }
  const std::set<AgentId>& fleet() const { return fleet_; }
  bool contains(const AgentId& agent) const { return fleet_.contains(agent); }
  /// The ranges of the members' items; counts the others.
  std::vector<SeqRange> of_members(const std::vector<SeqRange>& ranges);

  /// Counts an item that a stranger made or computed.
  void refuse_item() { ++strangers_; }
  /// Counts a message of a stranger, or an echo of an own one. True the first time that a stranger is heard,
  /// for the first 64 of them: a forger may use any number of names.
  bool refuse_message(const AgentId& sender);

  std::uint64_t strangers() const { return strangers_; }
  /// Strangers that refuse_message() has reported.
  std::size_t reported() const { return reported_.size(); }

 private:
  AgentId self_;
  std::set<AgentId> fleet_;
  std::uint64_t strangers_ = 0;
  std::set<AgentId> reported_;
};

}  // namespace fleetmap::exchange
