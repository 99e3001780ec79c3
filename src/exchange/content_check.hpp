#pragma once

#include <map>
#include <optional>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::Digest;
using messages::ItemRequest;

/// Finds names under which two robots hold different contents (one is forged, or the maker equivocates),
/// which digests of names alone do not show. Fingerprints of ranges are compared as in a Merkle tree: a
/// range whose fingerprint differs is cut in this robot's next digests, the peer compares the parts and cuts
/// those that differ, until the few remaining items are requested from the peer although they are held. The
/// store then receives both contents. A peer that sends false fingerprints causes a few cuts and requests at
/// growing intervals.
class ContentCheck {
 public:
  /// Compares the ranges that are held whole. True when one has to be cut.
  bool on_digest(const Digest& digest, const store::Store& store, Stamp now);
  /// `ranges` of nodes or alignments, cut where contents differ.
  std::vector<SeqRange> cut(const std::vector<SeqRange>& ranges, bool alignments) const;
  /// The items to request from `peer` although they are held.
  std::optional<ItemRequest> ask(const AgentId& self, const AgentId& peer, Stamp now);
  /// A name has become contested: the remaining differences are requested without delay.
  void on_contested();
  /// Removes cuts that have not been used for a while.
  void expire(Stamp now);

 private:
  using Cuts = std::map<NodeId, Stamp>;  ///< a range ends before this name; until when
  struct Peer {
    store::SeqSet nodes;  ///< to be requested
    store::SeqSet alignments;
    Stamp resting_until;
    Duration rest = Duration::zero();
  };
  bool compare(const SeqRange& range, std::uint32_t theirs, std::uint32_t ours, Cuts& cuts,
               store::SeqSet& to_ask, Stamp now);

  Cuts node_cuts_;
  Cuts alignment_cuts_;
  std::map<AgentId, Peer> peers_;
};

}  // namespace fleetmap::exchange
