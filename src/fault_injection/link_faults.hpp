#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "draws.hpp"
#include "fleetmap/fault_injection/scenario.hpp"
#include "fleetmap/messages/routing.hpp"

namespace fleetmap::fault_injection {

/// The effect of the active faults on packets. Each link has random numbers of its own, so that leaving out a
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
