#pragma once

#include <cstdint>
#include <functional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/exchange/exchange.hpp"

namespace fleetmap::exchange {

/// The same node, perhaps under another name.
bool is_same_place(const graph::Node& a, const graph::Node& b);

/// Services of the agent that naming own items anew requires.
struct NewNames {
  std::uint16_t session = 0;                                 ///< the running one, which names alignments
  std::function<Result<std::uint16_t>()> session_for_frame;  ///< an unused session
  /// An alignment as the wire makes it.
  std::function<Result<graph::Alignment>(const graph::Alignment&)> quantised;
};

/// Sends each own item whose name is contested again under a new name, so that a forged item costs the name
/// and not the node. Nodes of one odometry frame get a session of their own, since the running session may
/// be another frame, and an alignment from the odometry connects each of them to a neighbour that kept its
/// name. Items that have a new name already are recognised by their content, so the call may be repeated at
/// any time, also after a restart. Returns the number of nodes and alignments sent.
Result<std::size_t> reissue_contested(Exchange& exchange, store::Store& store, const NewNames& names,
                                      Stamp now);

}  // namespace fleetmap::exchange
