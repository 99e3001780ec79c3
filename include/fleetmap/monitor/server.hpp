#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/monitor/fleet_view.hpp"
#include "fleetmap/monitor/live_status.hpp"
#include "fleetmap/monitor/request_check.hpp"
#include "fleetmap/monitor/server_config.hpp"

namespace fleetmap::monitor {

/// One file of the page, gzip-compressed.
struct PageFile {
  const char* path;  ///< "/page.js"
  const char* type;  ///< "text/javascript"
  std::span<const std::uint8_t> gzip;
};
/// The page as built into the program; empty where it was built without npm.
std::span<const PageFile> built_in_page();
/// Why there is no page; empty if there is one.
std::string why_no_page();

/// Decodes a node's submap. Fails if its content has another hash, since the store may have been replaced.
using LoadSubmap = std::function<Result<cloud::PointCloud>(const NodeId&, const ContentHash&)>;

struct ServerStats {
  std::uint64_t requests = 0;
  std::uint64_t refused = 0;  ///< a wrong host, origin, token, method or path, or a malformed request
  std::uint64_t cut = 0;      ///< too slow, too many, or too long a header
  std::size_t viewers = 0;    ///< now
};

/// Shows a fleet to browsers: the page, its state and the points of submaps, over HTTP and one WebSocket a
/// viewer; and to clients of the Foxglove WebSocket protocol, on a thread of its own. Nobody waits for a
/// viewer: a viewer that is slow misses states, and is cut if it stays so. It only reads, but for the orders
/// of an operator (set_operator()).
class Server {
 public:
  /// `load` is called on the server's thread, and on others at the same time with preview_threads.
  static Result<std::unique_ptr<Server>> start(const ServerConfig& config, LoadSubmap load,
                                               std::span<const PageFile> page = built_in_page());
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// To open in a browser: with the token, if there is one.
  std::string url() const;
  /// Replaces what is shown. Returns at once.
  void publish(std::shared_ptr<const FleetView> view);
  /// Likewise. A status that the server's thread has not taken yet is replaced, so none queue up.
  void publish(std::shared_ptr<const LiveStatus> status);
  /// Passes on an operator's order, on the server's thread; fails with the reason.
  using GiveOrder = std::function<Status(const OrderRequest&)>;
  /// Lets viewers give orders. Without a token there are none: anyone on the machine would give them.
  void set_operator(GiveOrder give_order);
  ServerStats stats() const;

  struct State;  ///< server_state.hpp

 private:
  explicit Server(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::monitor
