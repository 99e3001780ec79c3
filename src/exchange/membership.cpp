#include "membership.hpp"

#include <algorithm>
#include <iterator>

namespace fleetmap::exchange {
namespace {

constexpr std::size_t kMaxReported = 64;

}  // namespace

std::vector<SeqRange> Membership::of_members(const std::vector<SeqRange>& ranges) {
  std::vector<SeqRange> known;
  std::ranges::copy_if(ranges, std::back_inserter(known),
                       [this](const SeqRange& range) { return contains(range.agent); });
  strangers_ += ranges.size() - known.size();
  return known;
}

bool Membership::refuse_message(const AgentId& sender) {
  ++strangers_;
  return sender != self_ && reported_.size() < kMaxReported && reported_.insert(sender).second;
}

}  // namespace fleetmap::exchange
