#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace fleetmap::monitor {

/// The network's side of an open WebSocket.
class WebSocket {
 public:
  enum class Kind { text, binary };
  /// A message is written as if its parts were one.
  using Parts = std::array<std::string_view, 2>;

  virtual ~WebSocket() = default;
  /// Writes one message. Its bytes stay, and no other is written, until WebSocketSession::on_written().
  virtual void write(Kind kind, Parts parts) = 0;
  /// Ends the connection without the closing handshake, which a browser may never answer.
  virtual void cut() = 0;
};

/// The server's side of a WebSocket: a page or a Foxglove client. The connection owns it and destroys it when
/// it ends.
class WebSocketSession {
 public:
  struct Limits {
    std::size_t message_bytes;  ///< of one that is received; a longer one ends the connection
    std::size_t frame_bytes;    ///< of a frame that is written; pings go between two frames
  };

  virtual ~WebSocketSession() = default;
  virtual Limits limits() const = 0;
  /// `socket` lives as long as the session does.
  virtual void on_open(WebSocket& socket) = 0;
  virtual void on_message(WebSocket::Kind kind, std::string_view message) = 0;
  virtual void on_written() = 0;
  /// The other side has gone or was too slow: nothing can be written any more.
  virtual void on_closed() = 0;
};

}  // namespace fleetmap::monitor
