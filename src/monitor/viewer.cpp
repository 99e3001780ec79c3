#include "viewer.hpp"

#include <utility>

namespace fleetmap::monitor {
namespace {

namespace websocket = beast::websocket;

constexpr std::size_t kMaxReceivedBytes = 1024;  // the page sends nothing yet

}  // namespace

Viewer::~Viewer() {
  if (state_.viewers.erase(this) > 0) --state_.viewers_now;
}

void Viewer::run(const Request& request) {
  // The stream's own deadline would end the WebSocket with it; the WebSocket's timeout pings instead.
  beast::get_lowest_layer(socket_).expires_never();
  socket_.set_option(
      websocket::stream_base::timeout{state_.config.request_timeout, state_.config.idle_timeout, true});
  socket_.read_message_max(0);  // pieces of a message are dropped as they come
  state_.viewers.insert(this);
  ++state_.viewers_now;
  socket_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (error) return;
    self->open_ = true;
    self->send(kState, self->state_.content.state());
    self->send(kLive, self->state_.content.live());
    self->read();
  });
}

void Viewer::send(Kind kind, std::shared_ptr<const std::string> text) {
  if (!open_ || text->empty()) return;
  next_[kind] = std::move(text);
  write_next();
}

void Viewer::write_next() {
  if (writing_) return;
  // A status is small and due each second, so it does not wait behind states.
  for (const Kind kind : {kLive, kState}) {
    if (!writing_) writing_ = std::exchange(next_[kind], nullptr);
  }
  if (!writing_) return;
  socket_.text(true);
  socket_.async_write(net::buffer(*writing_), [self = shared_from_this()](error_code error, std::size_t) {
    self->writing_.reset();
    if (!error && self->open_) self->write_next();
  });
}

void Viewer::read() {
  const auto on_bytes = [self = shared_from_this()](error_code error, std::size_t bytes) {
    self->buffer_.consume(self->buffer_.size());
    self->received_ += bytes;
    if (!error && self->received_ <= kMaxReceivedBytes) return self->read();
    self->open_ = false;
    if (error != websocket::error::closed) ++self->state_.cut;
    // Closes without the closing handshake, which the page may never answer.
    beast::get_lowest_layer(self->socket_).close();
  };
  socket_.async_read_some(buffer_, kMaxReceivedBytes, on_bytes);
}

}  // namespace fleetmap::monitor
