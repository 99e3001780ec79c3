#pragma once

#include <array>
#include <memory>
#include <string>

#include "server_state.hpp"
#include "web_socket.hpp"

namespace fleetmap::monitor {

/// The WebSocket of an open page. It gets every state, or only the newest of each kind if it is too slow for
/// all.
class Viewer : public WebSocketSession {
 public:
  explicit Viewer(ServerState& state);
  ~Viewer() override;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  enum Kind : std::size_t { kState, kLive };
  /// An empty text is not sent.
  void send(Kind kind, std::shared_ptr<const std::string> text);

  Limits limits() const override;
  void on_open(WebSocket& socket) override;
  void on_message(WebSocket::Kind kind, std::string_view message) override;
  void on_written() override;
  void on_closed() override { socket_ = nullptr; }

 private:
  void write_next();

  ServerState& state_;
  WebSocket* socket_ = nullptr;  ///< while it is open
  std::shared_ptr<const std::string> writing_;
  std::array<std::shared_ptr<const std::string>, 2> next_;  ///< by kind
  std::size_t received_ = 0;                                ///< bytes
};

}  // namespace fleetmap::monitor
