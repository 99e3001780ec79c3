#pragma once

#include <cstdint>
#include <functional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/exchange/exchange.hpp"

namespace fleetmap::exchange {

/// The same node, perhaps under another name.
bool is_same_place(const graph::Node& a, const graph::Node& b);

/// What naming own items anew needs of the agent.
struct NewNames {
  std::uint16_t session = 0;                                 ///< the running one, which names alignments
  std::function<Result<std::uint16_t>()> session_for_frame;  ///< an unused session
  /// An alignment as the wire makes it.
  std::function<Result<graph::Alignment>(const graph::Alignment&)> quantised;
};

/// Tells the fleet again, under fresh names, each own item whose name is contested, so that a forged item
/// costs the name and not the node. Nodes of one odometry frame go into a session of their own, since the
/// running one may be another frame, and an alignment made of the odometry ties each of them to a neighbour
/// that kept its name. What was named anew already is found by its content, so this may be repeated at any
/// time, also after a restart. Returns how many nodes and alignments were told.
Result<std::size_t> reissue_contested(Exchange& exchange, store::Store& store, const NewNames& names,
                                      Stamp now);

}  // namespace fleetmap::exchange
