#include "content_check.hpp"

#include <algorithm>

namespace fleetmap::exchange {
namespace {

constexpr std::uint32_t kParts = 8;     ///< that a range is cut into
constexpr std::uint32_t kFewItems = 8;  ///< requested instead of cutting further
constexpr std::size_t kMaxCuts = 64;    ///< of nodes, and of alignments
constexpr Duration kCutsLast = std::chrono::minutes(2);
constexpr Duration kFirstRest =
    std::chrono::seconds(10);  ///< of a peer between requests, then twice as long, ...
constexpr Duration kLongestRest = std::chrono::minutes(10);

}  // namespace

bool ContentCheck::compare(const SeqRange& range, std::uint32_t theirs, std::uint32_t ours, Cuts& cuts,
                           store::SeqSet& to_ask, Stamp now) {
  if (theirs == ours) return false;
  const std::uint32_t items = range.end - range.first;
  const bool few = items <= kFewItems;
  if (few) to_ask.insert(range);
  // Few items are cut off as well: if this robot alone holds both contents, the peer has to ask, not this
  // one.
  const std::uint32_t parts = few ? 1 : kParts;
  bool is_new = false;
  for (std::uint32_t part = 0; part <= parts; ++part) {
    const NodeId at{range.agent,
                    range.first + static_cast<std::uint32_t>(std::uint64_t{items} * part / parts)};
    const bool is_cut = cuts.contains(at);
    if (cuts.size() >= kMaxCuts && !is_cut) return !few;
    cuts[at] = now + kCutsLast;
    is_new |= !is_cut;
  }
  return is_new || !few;
}

bool ContentCheck::on_digest(const Digest& digest, const store::Store& store, Stamp now) {
  bool differ = false;
  Peer& peer = peers_[digest.from];
  const auto held = [](const store::SeqSet& set, const SeqRange& range) {
    return range.first < range.end && set.includes(store::SeqSet({range}));
  };
  for (std::size_t k = 0; k < std::min(digest.nodes.size(), digest.node_prints.size()); ++k) {
    const SeqRange& range = digest.nodes[k];
    if (!held(store.node_set(), range)) continue;
    differ |= compare(range, digest.node_prints[k], store.node_print(range), node_cuts_, peer.nodes, now);
  }
  for (std::size_t k = 0; k < std::min(digest.alignments.size(), digest.alignment_prints.size()); ++k) {
    const SeqRange& range = digest.alignments[k];
    if (!held(store.alignment_set(), range)) continue;
    differ |= compare(range, digest.alignment_prints[k], store.alignment_print(range), alignment_cuts_,
                      peer.alignments, now);
  }
  return differ;
}

std::vector<SeqRange> ContentCheck::cut(const std::vector<SeqRange>& ranges, bool alignments) const {
  const Cuts& cuts = alignments ? alignment_cuts_ : node_cuts_;
  std::vector<SeqRange> parts;
  for (SeqRange rest : ranges) {
    for (auto it = cuts.upper_bound({rest.agent, rest.first});
         it != cuts.end() && it->first.agent == rest.agent && it->first.seq < rest.end; ++it) {
      parts.push_back({rest.agent, rest.first, it->first.seq});
      rest.first = it->first.seq;
    }
    parts.push_back(rest);
  }
  return parts;
}

std::optional<ItemRequest> ContentCheck::ask(const AgentId& self, const AgentId& name, Stamp now) {
  const auto found = peers_.find(name);
  if (found == peers_.end()) return std::nullopt;
  Peer& peer = found->second;
  if ((peer.nodes.empty() && peer.alignments.empty()) || now < peer.resting_until) return std::nullopt;
  const auto few = [](const store::SeqSet& set) { return set.minus({}, kFewItems); };
  ItemRequest request{self, name, few(peer.nodes), few(peer.alignments)};
  // Ranges that still differ then appear in the peer's next digest.
  peer.nodes = {};
  peer.alignments = {};
  peer.rest = std::clamp(2 * peer.rest, kFirstRest, kLongestRest);
  peer.resting_until = now + peer.rest;
  return request;
}

void ContentCheck::on_contested() {
  for (auto& [name, peer] : peers_) {
    peer.rest = Duration::zero();
    peer.resting_until = Stamp{};
  }
}

void ContentCheck::expire(Stamp now) {
  for (Cuts* cuts : {&node_cuts_, &alignment_cuts_}) {
    std::erase_if(*cuts, [now](const auto& cut) { return now >= cut.second; });
  }
}

}  // namespace fleetmap::exchange
