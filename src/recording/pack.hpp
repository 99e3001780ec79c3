#pragma once

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::recording {

/// Compress bytes to one frame, fast rather than small. Errors when there is no memory.
Result<Bytes> pack_zstd(ByteView bytes);
Result<Bytes> pack_lz4(ByteView bytes);

}  // namespace fleetmap::recording
