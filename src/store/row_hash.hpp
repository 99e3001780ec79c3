#pragma once

#include <string_view>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::store {

/// Shows that the row of an item is whole: covers the item and its signature. Without a signature it is the
/// hash of the item alone.
ContentHash row_hash(ByteView item, ByteView signature);

/// The same for a named value.
ContentHash value_hash(std::string_view key, ByteView value);

}  // namespace fleetmap::store
