#pragma once

#include <cstdint>

#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::store {

/// 32 bits of a hash of an item's content, equal on every machine. In stores of older versions the last bits
/// of an item's numbers are those of the C library, which differ between processors, so rotations are rounded
/// to 1e-6 and the rest to single precision, finer than any two contents of the wire differ.
std::uint32_t fingerprint(const graph::Node& node);
std::uint32_t fingerprint(const graph::Alignment& alignment);
/// The fingerprint of a contested name, equal for any two contents that prove it.
std::uint32_t fingerprint_of_contested(const NodeId& name);

}  // namespace fleetmap::store
