#pragma once

#include <array>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <string>

#include "server_state.hpp"

namespace fleetmap::monitor {

/// The WebSocket of an open page. It gets every state, or only the newest of each kind if it is too slow for
/// all.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(ServerState& state, beast::tcp_stream stream, std::shared_ptr<CountedConnection> counted)
      : state_(state), counted_(std::move(counted)), socket_(std::move(stream)) {}
  ~Viewer();

  /// Accepts the WebSocket that `request` opens and sends the present state.
  void run(const Request& request);
  enum Kind : std::size_t { kState, kLive };
  /// An empty text is not sent.
  void send(Kind kind, std::shared_ptr<const std::string> text);

 private:
  void read();
  void write_next();

  ServerState& state_;
  std::shared_ptr<CountedConnection> counted_;
  beast::websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::shared_ptr<const std::string> writing_;
  std::array<std::shared_ptr<const std::string>, 2> next_;  ///< by kind
  std::size_t received_ = 0;                                ///< bytes
  bool open_ = false;
};

}  // namespace fleetmap::monitor
