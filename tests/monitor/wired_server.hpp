#pragma once

#include <boost/asio/write.hpp>
#include <functional>
#include <memory>
#include <string>

#include "monitor/connection.hpp"
#include "monitor/viewer.hpp"

namespace fleetmap::testing {

/// A server without a thread: one connection from here to it, all of whose events run in run_until().
class WiredServer {
 public:
  explicit WiredServer(const monitor::ServerConfig& config = {})
      : state_(
            config, [](const NodeId&) { return Result<cloud::PointCloud>(); }, kPage) {
    namespace net = monitor::net;
    monitor::tcp::acceptor acceptor(state_.io, {net::ip::make_address("127.0.0.1"), 0});
    client_.connect(acceptor.local_endpoint());
    std::make_shared<monitor::Connection>(state_, acceptor.accept())->read();
    listen();
  }

  void send(const std::string& bytes) { monitor::net::write(client_, monitor::net::buffer(bytes)); }
  void get(const std::string& path, const std::string& headers = "", const std::string& method = "GET") {
    send(method + " " + path + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n");
  }
  void hang_up() { client_.shutdown(monitor::tcp::socket::shutdown_send); }
  /// False if nothing is left that could happen.
  bool run_until(const std::function<bool()>& done) {
    while (!done()) {
      if (state_.io.run_one() == 0) return done();
    }
    return true;
  }
  /// Runs what can happen at once.
  void wait_until_idle() {
    while (state_.io.poll() > 0) {
    }
  }

  monitor::ServerState& state() { return state_; }
  /// All that came.
  const std::string& got() const { return got_; }
  bool closed() const { return closed_; }

 private:
  void listen() {
    client_.async_read_some(monitor::net::buffer(buffer_),
                            [this](monitor::error_code error, std::size_t size) {
                              got_.append(buffer_.data(), size);
                              closed_ = static_cast<bool>(error);
                              if (!closed_) listen();
                            });
  }

  static constexpr std::uint8_t kFile[] = {'p', 'a', 'g', 'e'};
  static constexpr monitor::PageFile kPage[] = {{"/index.html", "text/html", kFile}};
  monitor::ServerState state_;
  monitor::tcp::socket client_{state_.io};
  std::array<char, 65536> buffer_{};
  std::string got_;
  bool closed_ = false;
};

}  // namespace fleetmap::testing
