#pragma once

namespace fleetmap {

/// Remedy where datagrams are lost because the system grants sockets too little: a scan of 3 MB comes in one
/// burst. deploy/package/sysctl.conf does so.
inline constexpr const char* kRaiseReceiveBuffer =
    "set net.core.rmem_max to 8388608 in /etc/sysctl.d, as the Debian package does";

}  // namespace fleetmap
