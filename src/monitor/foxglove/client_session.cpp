#include "client_session.hpp"

#include <utility>

#include "fleetmap/core/utc.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

namespace websocket = beast::websocket;

constexpr std::size_t kMaxMessageBytes = 64u << 10;  // of a client
constexpr std::size_t kFrameBytes = 64u << 10;       // of a message; pings go between two frames
constexpr std::size_t kMaxTexts = 16;                // that wait for a client

}  // namespace

ClientSession::~ClientSession() {
  if (state_.foxglove_clients.erase(this) > 0) --state_.viewers_now;
}

void ClientSession::run(const Request& request, const std::string& subprotocol) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket's own timeout pings instead
  socket_.set_option(
      websocket::stream_base::timeout{state_.config.request_timeout, state_.config.idle_timeout, true});
  socket_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
    response.set(http::field::sec_websocket_protocol, subprotocol);
  }));
  socket_.read_message_max(kMaxMessageBytes);
  socket_.write_buffer_bytes(kFrameBytes);
  state_.foxglove_clients.insert(this);
  ++state_.viewers_now;
  socket_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (error) return;
    self->open_ = true;
    self->texts_.push_back(server_info(self->state_.feed.session()));
    self->write_next();
    self->read();
  });
}

void ClientSession::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) {
      if (error != websocket::error::closed) ++self->state_.cut;
      return self->cut();
    }
    self->on_message();
    self->buffer_.consume(self->buffer_.size());
    if (self->open_) self->read();
  });
}

void ClientSession::cut() {
  open_ = false;
  beast::get_lowest_layer(socket_).close();
}

void ClientSession::on_message() {
  if (!socket_.got_text())
    return send_status(StatusLevel::warning, "publishing and calling services is not offered here");
  const auto bytes = buffer_.data();
  const auto request = parse_client_text({static_cast<const char*>(bytes.data()), bytes.size()});
  if (!request) return send_status(StatusLevel::error, request.error().message);
  if (const std::string problem = subscriptions_.apply(*request, state_.feed.channels()); !problem.empty())
    send_status(StatusLevel::warning, problem);
  state_.feed.build_map();
  write_next();
}

void ClientSession::send_status(StatusLevel level, const std::string& text) {
  if (!open_) return;
  texts_.push_back(status(level, text));
  if (texts_.size() > kMaxTexts) {  // it writes nonsense faster than it reads what that is
    ++state_.cut;
    return cut();
  }
  write_next();
}

std::string ClientSession::next_text() {
  if (!texts_.empty()) {
    std::string text = std::move(texts_.front());
    texts_.pop_front();
    return text;
  }
  const auto fresh = state_.feed.channels().subspan(advertised_);
  advertised_ += fresh.size();
  return fresh.empty() ? std::string() : advertise(fresh);
}

template <class Buffers>
void ClientSession::write(bool is_text, const Buffers& buffers) {
  writing_ = true;
  socket_.text(is_text);
  socket_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t) {
    self->writing_ = false;
    self->message_.reset();
    if (!error) self->write_next();
  });
}

void ClientSession::write_next() {
  if (!open_ || writing_) return;
  text_ = next_text();
  if (!text_.empty()) return write(true, net::buffer(text_));
  while (const auto due = subscriptions_.next_due(state_.feed.channels())) {
    message_ = state_.feed.message(due->channel);
    if (!message_) continue;
    header_ = message_header(due->id, system_now());
    return write(false, std::array<net::const_buffer, 2>{net::buffer(header_), net::buffer(*message_)});
  }
}

}  // namespace fleetmap::monitor::foxglove
