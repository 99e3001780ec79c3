#pragma once

#include <atomic>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <set>
#include <string>
#include <thread>

#include "content.hpp"
#include "fleetmap/monitor/server.hpp"
#include "foxglove/feed.hpp"
#include "http_types.hpp"
#include "latest_slot.hpp"
#include "preview_maker.hpp"

namespace fleetmap::monitor {

class Viewer;

/// State shared by the listener, the connections and the viewers of one server. Only the server's thread uses
/// it, except the atomic counters and `io`, to which other threads post.
struct Server::State {
  State(const ServerConfig& config_, store::SubmapLoader load, std::span<const PageFile> page)
      : config(config_), content(page, std::move(load), config_.cached_bytes) {}

  const ServerConfig config;
  std::string cookie;  ///< its name; cookies are shared by all ports of a host
  Content content;
  LatestSlot<LiveStatus> live;  ///< filled by any thread
  Server::GiveOrder give_order;
  std::set<Viewer*> viewers;
  std::set<foxglove::Client*> foxglove_clients;
  std::size_t connections = 0;
  std::atomic<std::uint64_t> requests{0}, refused{0}, cut{0};
  std::atomic<std::size_t> viewers_now{0};
  net::io_context io{1};
  tcp::acceptor acceptor{io};
  net::steady_timer pause{io};
  foxglove::Feed feed{io, content, foxglove_clients, {config.foxglove_points, config.foxglove_map_period}};
  PreviewMaker previews{io, content, config.preview_threads, config.background};
  std::uint16_t port = 0;
  std::thread thread;

  bool operated() const { return !config.token.empty() && give_order != nullptr; }
  void accept();
  void run();
};

using ServerState = Server::State;

/// Counts a connection as long as it exists, however it ends.
class CountedConnection {
 public:
  explicit CountedConnection(ServerState& state) : state_(&state) { ++state_->connections; }
  ~CountedConnection() { --state_->connections; }
  CountedConnection(const CountedConnection&) = delete;
  CountedConnection& operator=(const CountedConnection&) = delete;

 private:
  ServerState* state_;
};

}  // namespace fleetmap::monitor
