#pragma once

#include "server_state.hpp"

namespace fleetmap::monitor {

/// Checks who asks and answers with the page, a state or a submap. The status `switching_protocols` means
/// that the caller may open a WebSocket: that of a Foxglove client if the response names a subprotocol, else
/// that of a page. Counts what it refuses.
Response answer(ServerState& state, const Request& request);

}  // namespace fleetmap::monitor
