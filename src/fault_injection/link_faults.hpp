#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "fleetmap/fault_injection/draws.hpp"
#include "fleetmap/fault_injection/scenario.hpp"
#include "fleetmap/messages/routing.hpp"

namespace fleetmap::fault_injection {

/// What the faults under way do to packets. Each link has random numbers of its own, so that to leave out a
/// fault changes little else.
class LinkFaults {
 public:
  explicit LinkFaults(std::uint64_t seed) : seed_(seed) {}

  void begin(const Fault& fault) { active_.push_back(&fault); }
  void end(const Fault& fault) { std::erase(active_, &fault); }

  /// After which delays copies of a packet arrive; none: it is lost.
  std::vector<Duration> arrivals(std::size_t from, std::size_t to, messages::Reach reach);
  bool cuts(std::size_t from, std::size_t to, messages::Reach reach) const;

 private:
  std::uint64_t seed_;
  std::vector<const Fault*> active_;
  std::map<std::tuple<std::size_t, std::size_t, messages::Reach>, Draws> draws_;
};

}  // namespace fleetmap::fault_injection
