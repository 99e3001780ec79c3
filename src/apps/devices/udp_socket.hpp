#pragma once

#include <cstdint>
#include <system_error>
#include <tl/expected.hpp>

#include "udp_socket_options.hpp"

namespace fleetmap::apps {

/// A socket that does not block and receives at `port` of all addresses of this machine; 0: any port that is
/// free. The error std::errc::address_in_use means that another program receives there. Options that the
/// system does not grant are no error.
tl::expected<int, std::error_code> open_udp_socket(std::uint16_t port, const UdpSocketOptions& options = {});
/// The port of a socket, also one that the system chose.
std::uint16_t udp_port_of(int socket);

}  // namespace fleetmap::apps
