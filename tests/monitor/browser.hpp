#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace fleetmap::testing {

/// The port of the page that a program announced in what it said; 0 until it has.
inline std::uint16_t announced_port(const std::string& said) {
  constexpr std::string_view kUrl = "http://127.0.0.1:";
  const std::size_t url = said.find(kUrl);
  if (url == std::string::npos || said.find('\n', url) == std::string::npos) return 0;
  return static_cast<std::uint16_t>(std::stoul(said.substr(url + kUrl.size())));
}

/// A TCP connection to this machine, byte by byte: what a browser would send, and what none would.
class Browser {
 public:
  explicit Browser(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval patience{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
    host_ = "127.0.0.1:" + std::to_string(port);
  }
  ~Browser() { ::close(socket_); }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  bool connected() const { return connected_; }
  bool send(const std::string& bytes) {
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  void get(const std::string& path, const std::string& headers = "", const std::string& method = "GET") {
    send(method + " " + path + " HTTP/1.1\r\nHost: " + host_ + "\r\n" + headers + "\r\n");
  }
  void upgrade(const std::string& path = "/live", const std::string& headers = "") {
    get(path,
        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
            headers);
  }
  std::string host() const { return host_; }

  /// Status line, headers and body of one answer; empty if the connection closed first.
  std::string answer() {
    const std::size_t end = until("\r\n\r\n");
    if (end == std::string::npos) return {};
    const std::string head = take(end);
    const std::size_t length = head.find("Content-Length: ");
    const bool has_body = length != std::string::npos && head.find(" 101 ") == std::string::npos;
    return head + (has_body ? take(std::stoul(head.substr(length + 16))) : "");
  }
  /// All that comes until the other side closes.
  std::string rest() {
    while (more()) {
    }
    return std::exchange(pending_, {});
  }
  /// "200"
  std::string status() {
    const std::string all = answer();
    return all.size() > 12 ? all.substr(9, 3) : all;
  }
  /// A message of the WebSocket: kind 1 is text, 2 binary, 8 that it closed.
  struct Message {
    int kind = 8;
    std::string payload;
  };
  /// The next message that came over the WebSocket, all of its frames; pings are passed over.
  Message any_message() {
    Message whole;
    while (true) {
      const std::string head = take(2);
      if (head.size() < 2) return {};
      std::uint64_t length = static_cast<unsigned char>(head[1]) & 0x7fu;
      if (length >= 126) {
        const std::string more = take(length == 126 ? 2 : 8);
        length = 0;
        for (const char c : more) length = length << 8 | static_cast<unsigned char>(c);
      }
      const std::string payload = take(length);
      const int kind = head[0] & 0x0f;
      if (kind == 8) return {};
      if (kind > 8) continue;
      if (kind > 0) whole.kind = kind;
      whole.payload += payload;
      if ((head[0] & 0x80) != 0) return whole;
    }
  }
  /// The next text. Empty when the WebSocket closed.
  std::string message() {
    while (true) {
      const Message next = any_message();
      if (next.kind == 1) return next.payload;
      if (next.kind == 8) return {};
    }
  }
  /// Writes a message of the kind 1 (text) or 2 (binary) in one frame, masked with zeros.
  bool send_message(const std::string& payload, int kind = 1) {
    std::string frame(1, static_cast<char>(0x80 | kind));
    const std::size_t size = payload.size(), bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
    frame.push_back(static_cast<char>(0x80 | (bytes == 0 ? size : bytes == 2 ? 126 : 127)));
    for (std::size_t k = bytes; k-- > 0;) frame.push_back(static_cast<char>(size >> 8 * k));
    return send(frame + std::string(4, '\0') + payload);
  }
  /// The other side has closed (or reset); what came before is dropped. False when 20 s pass first.
  bool closed() {
    char buffer[4096];
    while (true) {
      const ssize_t got = ::recv(socket_, buffer, sizeof buffer, 0);
      if (got == 0 || (got < 0 && errno == ECONNRESET)) return true;
      if (got < 0) return false;
    }
  }

 private:
  bool more() {
    char buffer[65536];
    const ssize_t got = ::recv(socket_, buffer, sizeof buffer, 0);
    if (got <= 0) return false;
    pending_.append(buffer, static_cast<std::size_t>(got));
    return true;
  }
  std::size_t until(const std::string& mark) {
    while (pending_.find(mark) == std::string::npos) {
      if (!more()) return std::string::npos;
    }
    return pending_.find(mark) + mark.size();
  }
  std::string take(std::size_t size) {
    while (pending_.size() < size) {
      if (!more()) break;
    }
    std::string taken = pending_.substr(0, size);
    pending_.erase(0, taken.size());
    return taken;
  }

  int socket_;
  bool connected_ = false;
  std::string host_, pending_;
};

}  // namespace fleetmap::testing
