#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "web_socket.hpp"

namespace fleetmap::monitor {

/// A client's request. Headers that it did not send are empty.
struct HttpRequest {
  enum class Method { get, head, post, other };
  Method method = Method::get;
  std::string target;  ///< "/submaps?from=0&count=1"
  std::string host, origin, cookie, authorization;
  bool upgrade = false;      ///< to a WebSocket
  std::string subprotocols;  ///< that it offers for the WebSocket, with commas between them
};

struct HttpResponse {
  unsigned status = 200;
  std::vector<std::pair<std::string, std::string>> headers = {};
  std::string body = {};
  std::unique_ptr<WebSocketSession> session = nullptr;  ///< of the WebSocket that status 101 opens

  /// The first header of that name; empty if there is none.
  std::string_view header(std::string_view name) const;
};

}  // namespace fleetmap::monitor
