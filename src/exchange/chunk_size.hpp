#pragma once

#include <cstdint>

#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

inline constexpr std::uint32_t kChunk = store::Store::kChunkBytes;  ///< of a submap, as it is sent and stored

}  // namespace fleetmap::exchange
