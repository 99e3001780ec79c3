#include "client_session.hpp"

#include <utility>

#include "fleetmap/core/utc.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

constexpr std::size_t kMaxMessageBytes = 64u << 10;   // of a client
constexpr std::size_t kClientFrameBytes = 64u << 10;  // of a message; pings go between two frames
constexpr std::size_t kMaxTexts = 16;                 // that wait for a client

std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

ClientSession::ClientSession(ServerState& state) : state_(state) {
  state_.foxglove_clients.insert(this);
  ++state_.counters.viewers;
}

ClientSession::~ClientSession() {
  state_.foxglove_clients.erase(this);
  --state_.counters.viewers;
}

WebSocketSession::Limits ClientSession::limits() const {
  return {.message_bytes = kMaxMessageBytes, .frame_bytes = kClientFrameBytes};
}

void ClientSession::on_open(WebSocket& socket) {
  socket_ = &socket;
  texts_.push_back(server_info(state_.feed.session()));
  write_next();
}

void ClientSession::on_message(WebSocket::Kind kind, std::string_view message) {
  if (kind != WebSocket::Kind::text)
    return send_status(StatusLevel::warning, "publishing and calling services is not offered here");
  const auto request = parse_client_text(message);
  if (!request) return send_status(StatusLevel::error, request.error().message);
  if (const std::string problem = subscriptions_.apply(*request, state_.feed.channels()); !problem.empty())
    send_status(StatusLevel::warning, problem);
  state_.feed.build_map();
  write_next();
}

void ClientSession::send_status(StatusLevel level, const std::string& text) {
  if (socket_ == nullptr) return;
  texts_.push_back(status(level, text));
  if (texts_.size() > kMaxTexts) {  // it writes nonsense faster than it reads what that is
    ++state_.counters.cut;
    return std::exchange(socket_, nullptr)->cut();
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

void ClientSession::write(WebSocket::Kind kind, WebSocket::Parts parts) {
  writing_ = true;
  socket_->write(kind, parts);
}

void ClientSession::on_written() {
  writing_ = false;
  message_.reset();
  write_next();
}

void ClientSession::write_next() {
  if (socket_ == nullptr || writing_) return;
  text_ = next_text();
  if (!text_.empty()) return write(WebSocket::Kind::text, {text_, {}});
  while (const auto due = subscriptions_.next_due(state_.feed.channels())) {
    message_ = state_.feed.message(due->channel);
    if (!message_) continue;
    header_ = message_header(due->id, system_now());
    return write(WebSocket::Kind::binary, {text_of(header_), text_of(*message_)});
  }
}

}  // namespace fleetmap::monitor::foxglove
