#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::testing {

AgentId agent(const std::string& name);

/// A named value of a store.
inline const Bytes kMetaValue{1, 2, 3};

Bytes random_bytes(std::size_t size, std::uint32_t seed);

/// A node with awkward numbers (all depend on `seed`), `east_m` metres east of a fixed place.
graph::Node make_node(const AgentId& agent, std::uint32_t seq, const Bytes& submap, double east_m = 0.0,
                      std::uint32_t seed = 1);

graph::Alignment make_alignment(const NodeId& i, const NodeId& j, const AgentId& by, std::uint32_t seq,
                                double rmse = 0.2);

}  // namespace fleetmap::testing
