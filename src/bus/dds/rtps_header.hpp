#pragma once

#include <cstddef>
#include <optional>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::bus {

/// "RTPS", version, vendor, prefix of the sending participant (RTPS 2.2, 9.4.4).
inline constexpr std::size_t kRtpsHeaderBytes = 20;

/// Fast DDS with its statistics, as Debian builds it, appends this to each message: a submessage of 4 and 56,
/// which its UDP transport fills in. Nobody reads it here.
inline constexpr std::size_t kStatisticsBytes = 60;
ByteView without_statistics(ByteView rtps_message);
/// The transport looks at one byte alone: where this is true it overwrites the end of the datagram, whatever
/// it is.
bool ends_like_statistics(ByteView datagram);

/// The Hello that an RTPS message carries, as CDR; empty if it carries none.
std::optional<Bytes> hello_in(ByteView rtps_message);

}  // namespace fleetmap::bus
