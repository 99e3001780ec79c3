#pragma once

#include <cstddef>
#include <string>

#include "fleetmap/core/ids.hpp"

namespace fleetmap::monitor {

/// Pairs of nodes of two robots that one of them would register or has registered: its candidates, by their
/// state. The other robot has its own.
struct PairCandidates {
  AgentId by, with;
  bool ended = false;         ///< as they were when the robot ended
  bool heard = true;          ///< `with` is
  std::size_t waiting = 0;    ///< for complete clouds, or for a turn on the radio
  std::size_t requested = 0;  ///< the cloud is under way
  std::size_t registering = 0;
  std::size_t aligned = 0;
  std::size_t rejected = 0;       ///< registered, without an alignment
  std::size_t not_received = 0;   ///< never registered, since the cloud did not come
  std::size_t to_be_retried = 0;  ///< of these two
  std::size_t redundant = 0;      ///< dropped beside another candidate
  std::size_t overflowed = 0;     ///< dropped when too many waited
  std::size_t uninformative = 0;  ///< dropped while the radio was busy
  bool operator==(const PairCandidates&) const = default;
};

/// All of it in words.
std::string sentence(const PairCandidates& candidates);

}  // namespace fleetmap::monitor
