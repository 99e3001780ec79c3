#include "fleet_channels.hpp"

#include <algorithm>

#include "fleet_scene.hpp"

namespace fleetmap::monitor::foxglove {

FleetChannels::FleetChannels() {
  add("/fleet/transforms", ChannelKind::transforms);
  add("/fleet/trajectories", ChannelKind::trajectories);
  add("/fleet/alignments", ChannelKind::alignments);
  add("/fleet/map", ChannelKind::map);
}

void FleetChannels::add(const std::string& topic, ChannelKind kind, const AgentId& robot) {
  channels_.push_back({static_cast<std::uint32_t>(channels_.size() + 1), topic, kind, robot, 0});
  made_.emplace_back();
}

void FleetChannels::add_once(ChannelKind kind, const AgentId& robot) {
  const auto same = [&](const Channel& channel) { return channel.kind == kind && channel.robot == robot; };
  if (std::ranges::any_of(channels_, same)) return;
  add("/" + robot.str() + (kind == ChannelKind::fix ? "/fix" : "/status"), kind, robot);
}

void FleetChannels::show(std::shared_ptr<const FleetView> view) {
  view_ = std::move(view);
  last_nodes_ = last_nodes(*view_);
  for (const auto& [robot, last] : last_nodes_) {
    if (last.georeferenced) add_once(ChannelKind::fix, robot);
  }
  for (Channel& channel : channels_) {
    if (channel.kind != ChannelKind::status && channel.kind != ChannelKind::map) ++channel.revision;
  }
}

void FleetChannels::show(std::shared_ptr<const LiveStatus> status) {
  status_ = std::move(status);
  for (const RobotNow& robot : status_->robots) add_once(ChannelKind::status, robot.id);
  for (Channel& channel : channels_) {
    if (channel.kind == ChannelKind::status) ++channel.revision;
  }
}

void FleetChannels::show_map(Bytes message) {
  map_ = std::make_shared<const Bytes>(std::move(message));
  ++channels_[kMapChannel - 1].revision;
}

std::shared_ptr<const Bytes> FleetChannels::message(std::uint32_t id) {
  const Channel& channel = channels_.at(id - 1);
  Made& made = made_[id - 1];
  if (made.revision != channel.revision) made = {channel.revision, make(channel)};
  return made.message;
}

std::shared_ptr<const Bytes> FleetChannels::make(const Channel& channel) const {
  const auto shared = [](Bytes message) { return std::make_shared<const Bytes>(std::move(message)); };
  switch (channel.kind) {
    case ChannelKind::transforms:
      return shared(transforms_message(last_nodes_));
    case ChannelKind::trajectories:
      return shared(trajectories_message(*view_));
    case ChannelKind::alignments:
      return shared(alignments_message(*view_));
    case ChannelKind::map:
      return map_;
    case ChannelKind::fix: {
      const auto last = last_nodes_.find(channel.robot);
      if (last == last_nodes_.end() || !last->second.georeferenced) return nullptr;
      return shared(fix_message(channel.robot, last->second, view_->origin));
    }
    case ChannelKind::status: {
      const auto robot = std::ranges::find(status_->robots, channel.robot, &RobotNow::id);
      return robot == status_->robots.end() ? nullptr : shared(status_message(*robot));
    }
  }
  return nullptr;
}

}  // namespace fleetmap::monitor::foxglove
