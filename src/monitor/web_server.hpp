#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "event_loop.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/monitor/server_config.hpp"
#include "http_message.hpp"
#include "server_counters.hpp"

namespace fleetmap::monitor {

/// HTTP and WebSockets on one port, all on the thread that calls run(). Its source is the only one that
/// includes Boost.Beast and Boost.Asio, which take seconds to compile.
///
/// Slow and malformed clients are cut and counted.
class WebServer : public EventLoop {
 public:
  /// Answers a request. A response of status 101 opens its session's WebSocket.
  using Answer = std::function<HttpResponse(const HttpRequest&)>;
  static constexpr std::uint32_t kMaxHeaderBytes = 8192;  ///< of a request

  /// Both arguments outlive it.
  WebServer(const ServerConfig& config, ServerCounters& counters);
  /// Destroys all sessions. run() has returned.
  ~WebServer() override;

  /// Opens the port; connections are served as soon as run() is called.
  Status listen(Answer answer);
  std::uint16_t port() const;
  /// Serves until stop(). An exception of an answer or a session ends its connection alone.
  void run();
  /// Any thread may call it.
  void stop();

  void post(Task task) override;
  void post_at(Clock::time_point time, Task task) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The request that `bytes` begin with, as connections read it; none if it is incomplete or malformed.
std::optional<HttpRequest> parse_request(std::string_view bytes);

}  // namespace fleetmap::monitor
