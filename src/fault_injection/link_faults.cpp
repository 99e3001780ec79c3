#include "link_faults.hpp"

#include <algorithm>

namespace fleetmap::fault_injection {
namespace {

constexpr double kMinDelay = 0.005, kMaxDelay = 0.06;  // s, without faults
constexpr std::uint64_t kLinkStream = 5;

bool names(const Fault& fault, std::size_t robot) { return std::ranges::count(fault.robots, robot) > 0; }

bool concerns(const Fault& fault, std::size_t from, std::size_t to, messages::Reach reach) {
  if (!(reach == messages::Reach::kLongRange ? fault.radio : fault.short_range)) return false;
  return fault.robots.empty() || names(fault, from) || names(fault, to);
}

bool cut_by(const Fault& fault, std::size_t from, std::size_t to) {
  if (fault.kind == FaultKind::kOneWay) return fault.robots[0] == from && fault.robots[1] == to;
  return fault.kind == FaultKind::kPartition && names(fault, from) != names(fault, to);
}

}  // namespace

bool LinkFaults::cuts(std::size_t from, std::size_t to, messages::Reach reach) const {
  return std::ranges::any_of(active_, [&](const Fault* fault) {
    return concerns(*fault, from, to, reach) && cut_by(*fault, from, to);
  });
}

std::vector<Duration> LinkFaults::arrivals(std::size_t from, std::size_t to, messages::Reach reach) {
  const std::uint64_t link = kLinkStream + 1000 * from + 2 * to + (reach == messages::Reach::kLongRange);
  Draws& draws = draws_.try_emplace({from, to, reach}, seed_, link << 8).first->second;
  if (cuts(from, to, reach)) return {};
  double more_delay = 0.0;
  int copies = 1;
  for (const Fault* fault : active_) {
    if (!concerns(*fault, from, to, reach)) continue;
    if (fault->kind == FaultKind::kLoss && draws.chance(fault->value)) copies = 0;
    if (fault->kind == FaultKind::kDelay) more_delay = std::max(more_delay, fault->value);
    if (fault->kind == FaultKind::kDuplication && copies == 1 && draws.chance(fault->value)) copies = 2;
  }
  std::vector<Duration> delays;
  for (int k = 0; k < copies; ++k)
    delays.push_back(from_seconds(draws.between(kMinDelay, kMaxDelay) + draws.between(0.0, more_delay)));
  return delays;
}

}  // namespace fleetmap::fault_injection
