#include "feed.hpp"

#include <algorithm>

#include "fleetmap/monitor/request_check.hpp"

namespace fleetmap::monitor::foxglove {

Feed::Feed(EventLoop& loop, Content& content, const std::set<Client*>& clients, const FeedConfig& config)
    : loop_(loop),
      clients_(clients),
      config_(config),
      session_(random_token()),
      map_(config.map_points, [&content](const graph::Node& node) { return content.cloud(node); }) {}

void Feed::show(std::shared_ptr<const FleetView> view) {
  view_ = view;
  outdated_ = true;
  channels_.show(std::move(view));
  wake_all();
  build_map();
}

void Feed::show(std::shared_ptr<const LiveStatus> status) {
  channels_.show(std::move(status));
  wake_all();
}

void Feed::wake_all() {
  for (Client* client : clients_) client->wake();
}

bool Feed::map_is_wanted() const {
  return std::ranges::any_of(clients_, [](const Client* client) { return client->wants_map(); });
}

void Feed::build_map() {
  if (building_ || !outdated_ || !map_is_wanted()) return;
  building_ = true;
  loop_.post_at(next_map_, [this] {
    outdated_ = false;
    map_.begin(view_);
    next_submap();
  });
}

void Feed::next_submap() {
  building_ = false;  // also where a submap throws: the next view begins anew
  if (!map_is_wanted()) {
    outdated_ = true;
    return;
  }
  if (!map_.step()) return finish_map();
  building_ = true;
  loop_.post([this] { next_submap(); });
}

void Feed::finish_map() {
  channels_.show_map(map_.message());
  next_map_ = EventLoop::Clock::now() + config_.map_period;
  const std::vector<NodeId>& unreadable = map_.unreadable();
  for (Client* client : clients_) {
    if (!unreadable.empty() && client->wants_map())
      client->warn(std::to_string(unreadable.size()) +
                   " submaps cannot be read and are missing from /fleet/map; the first is " +
                   to_string(unreadable.front()));
    client->wake();
  }
  build_map();
}

}  // namespace fleetmap::monitor::foxglove
