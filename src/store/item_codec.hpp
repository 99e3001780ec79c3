#pragma once

#include <optional>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::store {

/// Items as rows hold them: every number bit for bit, little-endian, so that two items are equal exactly when
/// their bytes are.
Bytes encode(const graph::Node& node);
Bytes encode(const graph::Alignment& alignment);
/// Nothing when `bytes` are not what encode makes.
std::optional<graph::Node> decode_node(ByteView bytes);
std::optional<graph::Alignment> decode_alignment(ByteView bytes);

}  // namespace fleetmap::store
