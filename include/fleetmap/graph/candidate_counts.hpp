#pragma once

#include <cstdint>

namespace fleetmap::graph {

/// Pairs of nodes of two robots that one of them would register, or has registered, by what became of them.
struct CandidateCounts {
  std::uint64_t waiting = 0;    ///< for complete clouds, or for a turn on the radio
  std::uint64_t requested = 0;  ///< the cloud is under way
  std::uint64_t registering = 0;
  std::uint64_t aligned = 0;
  std::uint64_t rejected = 0;       ///< registered, without an alignment
  std::uint64_t not_received = 0;   ///< never registered, since the cloud did not come
  std::uint64_t to_be_retried = 0;  ///< of these two
  std::uint64_t redundant = 0;      ///< dropped beside another candidate
  std::uint64_t overflowed = 0;     ///< dropped when too many waited
  std::uint64_t uninformative = 0;  ///< dropped while the radio was busy: below min_information
  bool operator==(const CandidateCounts&) const = default;
};

}  // namespace fleetmap::graph
