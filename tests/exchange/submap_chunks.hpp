#pragma once

#include <cstdint>

#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

inline constexpr std::uint32_t kChunk = store::Store::kChunkBytes;
static_assert(kChunk == 8192);

}  // namespace fleetmap::exchange
