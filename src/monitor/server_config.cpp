#include "fleetmap/monitor/server_config.hpp"

#include "fleetmap/monitor/request_check.hpp"

namespace fleetmap::monitor {

Status ServerConfig::validate() const {
  if (!is_ip_address(address)) return failure(address + " is no IP address, as 127.0.0.1 or 0.0.0.0 are");
  if (token.empty() && !is_loopback(address))
    return failure(address + " is seen by others: a token is needed");
  if (!token.empty() && token.size() < kMinTokenLength)
    return failure("the token is shorter than " + std::to_string(kMinTokenLength) + " characters");
  if (max_viewers == 0 || max_connections == 0)
    return failure("max_viewers and max_connections must be positive");
  return {};
}

}  // namespace fleetmap::monitor
