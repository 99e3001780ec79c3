#pragma once

#include "http_message.hpp"
#include "server_state.hpp"

namespace fleetmap::monitor {

/// Checks who asks and answers with the page, a state, a submap or a WebSocket: that of a Foxglove client if
/// it offers a subprotocol of theirs, else that of a page. Counts what it refuses.
HttpResponse answer(ServerState& state, const HttpRequest& request);

}  // namespace fleetmap::monitor
