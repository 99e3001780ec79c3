#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

namespace fleetmap::testing {

/// gpsd at a port of this machine: sends its version to one client, and then `report()` every 100 ms.
class GpsdServer {
 public:
  explicit GpsdServer(std::function<std::string()> report)
      : report_(std::move(report)), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof here;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
    EXPECT_EQ(::listen(socket_, 1), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &length), 0);
    port_ = ntohs(here.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  }
  ~GpsdServer() {
    thread_ = {};
    ::close(socket_);
  }
  GpsdServer(const GpsdServer&) = delete;
  GpsdServer& operator=(const GpsdServer&) = delete;
  std::string place() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  static bool readable(int descriptor) {
    pollfd ready{descriptor, POLLIN, 0};
    return ::poll(&ready, 1, 100) > 0;
  }
  void serve(const std::stop_token& stop) const {
    while (!stop.stop_requested() && !readable(socket_)) {
    }
    if (stop.stop_requested()) return;
    const int client = ::accept(socket_, nullptr, nullptr);
    std::string text = "{\"class\":\"VERSION\",\"release\":\"3.22\"}\n";
    while (!stop.stop_requested()) {
      if (::send(client, text.data(), text.size(), MSG_NOSIGNAL) < 0) break;
      char request[256];
      if (readable(client) && ::recv(client, request, sizeof request, 0) <= 0) break;
      text = report_();
    }
    ::close(client);
  }

  std::function<std::string()> report_;
  int socket_;
  std::uint16_t port_ = 0;
  std::jthread thread_;
};

}  // namespace fleetmap::testing
