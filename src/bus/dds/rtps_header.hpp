#pragma once

#include <cstddef>
#include <optional>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::bus {

/// "RTPS", version, vendor, prefix of the sending participant (RTPS 2.2, 9.4.4).
inline constexpr std::size_t kRtpsHeaderBytes = 20;

/// The Hello that an RTPS message carries, as CDR; empty if it carries none.
std::optional<Bytes> hello_in(ByteView rtps_message);

}  // namespace fleetmap::bus
