#pragma once

#include <chrono>
#include <memory>
#include <set>
#include <span>
#include <string>

#include "content.hpp"
#include "event_loop.hpp"
#include "feed_config.hpp"
#include "fleet_channels.hpp"
#include "thinned_map.hpp"

namespace fleetmap::monitor::foxglove {

/// A client of the feed, as the feed sees it.
class Client {
 public:
  virtual ~Client() = default;
  /// There are newer messages or more channels.
  virtual void wake() = 0;
  virtual bool wants_map() const = 0;
  /// A text for the person in front of it.
  virtual void warn(const std::string& text) = 0;
};

/// Feeds Foxglove clients with what the server shows, on the server's thread.
///
/// The map is built while a client wants it and it is older than the view: one submap at a time, between
/// which the thread serves others, and with a pause of `map_period` after each.
class Feed {
 public:
  Feed(EventLoop& loop, Content& content, const std::set<Client*>& clients, const FeedConfig& config);

  void show(std::shared_ptr<const FleetView> view);
  void show(std::shared_ptr<const LiveStatus> status);
  /// A client may want the map now.
  void build_map();

  std::span<const Channel> channels() const { return channels_.channels(); }
  std::shared_ptr<const Bytes> message(std::uint32_t channel) { return channels_.message(channel); }
  const std::string& session() const { return session_; }

 private:
  bool map_is_wanted() const;
  void next_submap();
  void finish_map();
  void wake_all();

  EventLoop& loop_;
  const std::set<Client*>& clients_;
  FeedConfig config_;
  std::string session_;
  FleetChannels channels_;
  ThinnedMap map_;
  EventLoop::Clock::time_point next_map_{};  ///< may begin then
  std::shared_ptr<const FleetView> view_;
  bool outdated_ = false;  ///< the map, by `view_`
  bool building_ = false;
};

}  // namespace fleetmap::monitor::foxglove
