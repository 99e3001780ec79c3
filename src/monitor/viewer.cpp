#include "viewer.hpp"

#include <utility>

namespace fleetmap::monitor {
namespace {

constexpr std::size_t kMaxReceivedBytes = 1024;  // the page sends nothing yet
constexpr std::size_t kViewerFrameBytes = 4u << 10;

}  // namespace

Viewer::Viewer(ServerState& state) : state_(state) {
  state_.viewers.insert(this);
  ++state_.counters.viewers;
}

Viewer::~Viewer() {
  state_.viewers.erase(this);
  --state_.counters.viewers;
}

WebSocketSession::Limits Viewer::limits() const {
  return {.message_bytes = kMaxReceivedBytes, .frame_bytes = kViewerFrameBytes};
}

void Viewer::on_open(WebSocket& socket) {
  socket_ = &socket;
  send(kState, state_.content.state());
  send(kLive, state_.content.live());
}

void Viewer::send(Kind kind, std::shared_ptr<const std::string> text) {
  if (socket_ == nullptr || text->empty()) return;
  next_[kind] = std::move(text);
  write_next();
}

void Viewer::write_next() {
  if (socket_ == nullptr || writing_) return;
  // A status is small and due each second, so it does not wait behind states.
  for (const Kind kind : {kLive, kState}) {
    if (!writing_) writing_ = std::exchange(next_[kind], nullptr);
  }
  if (writing_) socket_->write(WebSocket::Kind::text, {*writing_, {}});
}

void Viewer::on_written() {
  writing_.reset();
  write_next();
}

void Viewer::on_message(WebSocket::Kind, std::string_view message) {
  received_ += message.size();
  if (received_ <= kMaxReceivedBytes || socket_ == nullptr) return;
  ++state_.counters.cut;
  std::exchange(socket_, nullptr)->cut();
}

}  // namespace fleetmap::monitor
