#pragma once

#include <set>
#include <string>
#include <thread>

#include "content.hpp"
#include "fleetmap/monitor/server.hpp"
#include "foxglove/feed.hpp"
#include "latest_slot.hpp"
#include "preview_maker.hpp"
#include "server_counters.hpp"
#include "web_server.hpp"

namespace fleetmap::monitor {

class Viewer;

/// State shared by the sessions of one server. Only the server's thread uses it, except `counters`, `live`
/// and WebServer::post().
struct Server::State {
  State(const ServerConfig& config_, LoadSubmap load, std::span<const PageFile> page)
      : config(config_), content(page, std::move(load), config_.cached_bytes) {}

  const ServerConfig config;
  std::string cookie;  ///< its name; cookies are shared by all ports of a host
  Content content;
  LatestSlot<LiveStatus> live;  ///< filled by any thread
  Server::GiveOrder give_order;
  std::set<Viewer*> viewers;
  std::set<foxglove::Client*> foxglove_clients;
  ServerCounters counters;
  WebServer web{config, counters};  ///< after all that its sessions use
  foxglove::Feed feed{web, content, foxglove_clients, {config.foxglove_points, config.foxglove_map_period}};
  PreviewMaker previews{
      web, content, config.preview_threads, config.background, config.preview_file, config.more_previews};
  std::thread thread;

  bool operated() const { return !config.token.empty() && give_order != nullptr; }
};

using ServerState = Server::State;

}  // namespace fleetmap::monitor
