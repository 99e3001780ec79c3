#pragma once

#include <array>
#include <deque>
#include <memory>
#include <string>

#include "feed.hpp"
#include "server_state.hpp"
#include "subscriptions.hpp"
#include "web_socket.hpp"

namespace fleetmap::monitor::foxglove {

/// The WebSocket of a Foxglove client. It gets the newest message of each channel that it subscribed to; what
/// it is too slow for is left out.
class ClientSession : public Client, public WebSocketSession {
 public:
  explicit ClientSession(ServerState& state);
  ~ClientSession() override;
  ClientSession(const ClientSession&) = delete;
  ClientSession& operator=(const ClientSession&) = delete;

  void wake() override { write_next(); }
  bool wants_map() const override {
    return socket_ != nullptr && subscriptions_.has(FleetChannels::kMapChannel);
  }
  void warn(const std::string& text) override { send_status(StatusLevel::warning, text); }

  Limits limits() const override;
  void on_open(WebSocket& socket) override;
  void on_message(WebSocket::Kind kind, std::string_view message) override;
  void on_written() override;
  void on_closed() override { socket_ = nullptr; }

 private:
  void send_status(StatusLevel level, const std::string& text);
  void write_next();
  std::string next_text();
  void write(WebSocket::Kind kind, WebSocket::Parts parts);

  ServerState& state_;
  WebSocket* socket_ = nullptr;  ///< while it is open
  Subscriptions subscriptions_;
  std::deque<std::string> texts_;  ///< that wait
  std::size_t advertised_ = 0;     ///< channels
  bool writing_ = false;
  // These are being written, so they must stay.
  std::string text_;
  std::array<std::uint8_t, 13> header_{};
  std::shared_ptr<const Bytes> message_;
};

}  // namespace fleetmap::monitor::foxglove
