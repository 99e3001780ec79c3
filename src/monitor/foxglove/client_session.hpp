#pragma once

#include <array>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <memory>
#include <string>

#include "feed.hpp"
#include "server_state.hpp"
#include "subscriptions.hpp"

namespace fleetmap::monitor::foxglove {

/// The WebSocket of a Foxglove client. It gets the newest message of each channel that it subscribed to; what
/// it is too slow for is left out.
class ClientSession : public Client, public std::enable_shared_from_this<ClientSession> {
 public:
  ClientSession(ServerState& state, beast::tcp_stream stream, std::shared_ptr<CountedConnection> counted)
      : state_(state), counted_(std::move(counted)), socket_(std::move(stream)) {}
  ~ClientSession() override;

  /// Accepts the WebSocket that `request` opens, with a subprotocol of chosen_subprotocol().
  void run(const Request& request, const std::string& subprotocol);
  void wake() override { write_next(); }
  bool wants_map() const override { return open_ && subscriptions_.has(FleetChannels::kMapChannel); }
  void warn(const std::string& text) override { send_status(StatusLevel::warning, text); }

 private:
  void read();
  void on_message();
  void send_status(StatusLevel level, const std::string& text);
  void write_next();
  std::string next_text();
  template <class Buffers>
  void write(bool is_text, const Buffers& buffers);
  void cut();

  ServerState& state_;
  std::shared_ptr<CountedConnection> counted_;
  beast::websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  Subscriptions subscriptions_;
  std::deque<std::string> texts_;  ///< that wait
  std::size_t advertised_ = 0;     ///< channels
  bool open_ = false, writing_ = false;
  // These are being written, so they must stay.
  std::string text_;
  std::array<std::uint8_t, 13> header_{};
  std::shared_ptr<const Bytes> message_;
};

}  // namespace fleetmap::monitor::foxglove
