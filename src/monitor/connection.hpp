#pragma once

#include <memory>
#include <optional>

#include "server_state.hpp"

namespace fleetmap::monitor {

/// Answers the requests of one HTTP connection, one after the other.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  static constexpr std::uint32_t kMaxHeaderBytes = 8192;  ///< of a request; longer ones are cut off

  Connection(ServerState& state, tcp::socket socket)
      : state_(state), counted_(std::make_shared<CountedConnection>(state)), stream_(std::move(socket)) {}

  /// Reads the next request and answers it.
  void read();

 private:
  void on_request(error_code error);
  /// Hands the connection to the WebSocket that `response` grants.
  void open(const Request& request, const Response& response);
  void write(Response response);
  void close();

  ServerState& state_;
  std::shared_ptr<CountedConnection> counted_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * kMaxHeaderBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
};

}  // namespace fleetmap::monitor
