#include "membership.hpp"

#include <algorithm>
#include <iterator>

namespace fleetmap::exchange {
namespace {

constexpr std::size_t kMaxReported = 64;

}  // namespace

std::vector<Range> Membership::of_members(const std::vector<Range>& ranges) {
  std::vector<Range> known;
  std::ranges::copy_if(ranges, std::back_inserter(known),
                       [this](const Range& range) { return contains(range.agent); });
  strangers_ += ranges.size() - known.size();
  return known;
}

bool Membership::refuse_message(const AgentId& sender) {
  ++strangers_;
  return sender != self_ && reported_.size() < kMaxReported && reported_.insert(sender).second;
}

}  // namespace fleetmap::exchange
