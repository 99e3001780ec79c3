#include "fingerprint_sums.hpp"

namespace fleetmap::store {
namespace {

constexpr std::uint64_t kBlock = 256;  // numbers

std::uint32_t sum(const std::map<NodeId, std::uint32_t>& prints, const AgentId& maker, std::uint64_t first,
                  std::uint64_t end) {
  std::uint32_t sum = 0;
  if (first >= end) return sum;
  for (auto it = prints.lower_bound({maker, static_cast<std::uint32_t>(first)});
       it != prints.end() && it->first.agent == maker && it->first.seq < end; ++it) {
    sum += it->second;
  }
  return sum;
}

}  // namespace

void FingerprintSums::set(const NodeId& name, std::uint32_t print) {
  std::uint32_t& held = prints_[name];
  blocks_[{name.agent, static_cast<std::uint32_t>(name.seq / kBlock * kBlock)}] += print - held;
  held = print;
}

std::uint32_t FingerprintSums::of(const SeqRange& range) const {
  const std::uint64_t first_block = (range.first + kBlock - 1) / kBlock * kBlock;
  const std::uint64_t end_blocks = range.end / kBlock * kBlock;
  if (first_block >= end_blocks) return sum(prints_, range.agent, range.first, range.end);
  return sum(prints_, range.agent, range.first, first_block) +
         sum(blocks_, range.agent, first_block, end_blocks) +
         sum(prints_, range.agent, end_blocks, range.end);
}

}  // namespace fleetmap::store
