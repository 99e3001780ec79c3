#pragma once

#include <cstdint>

namespace fleetmap::loop_closure {

/// States of a robot's candidates with one other robot, and how many of them were dropped.
struct PeerCandidates {
  bool heard = false;           ///< the other robot is; else no cloud is requested
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
};

}  // namespace fleetmap::loop_closure
