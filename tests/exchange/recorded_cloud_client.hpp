#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "fleetmap/exchange/cloud_client.hpp"

namespace fleetmap::exchange {

/// A loop closer that records what the transport reports and demands what the test has set.
class RecordedCloudClient final : public CloudClient {
 public:
  void on_node(const graph::Node& node, Stamp) override { nodes.push_back(node.id); }
  void on_contested(const NodeId& node) override { contested.push_back(node); }
  void on_alignment(const graph::Alignment& alignment, Stamp) override { alignments.push_back(alignment); }
  void on_match(const ProximityMatch& match, Stamp) override { matches.push_back(match); }
  void on_heard(const AgentId& peer, Stamp) override { heard.push_back(peer); }
  void on_cloud_request(const AgentId& peer, const NodeId& ours) override {
    requests.emplace_back(peer, ours);
  }
  void on_cloud(const NodeId& theirs, Bytes cloud) override { clouds.emplace_back(theirs, std::move(cloud)); }
  void on_cloud_lost(const NodeId& theirs, Stamp) override { lost.push_back(theirs); }
  CloudDemand tick(Stamp, bool radio_has_room) override {
    had_room = radio_has_room;
    return std::exchange(demand, {});
  }
  bool wants(const NodeId& theirs) const override { return std::ranges::count(wanted, theirs) > 0; }
  bool idle(Stamp, const std::set<AgentId>&) const override { return true; }

  CloudDemand demand;          ///< of the next tick
  std::vector<NodeId> wanted;  ///< answers of wants()
  std::vector<NodeId> nodes, contested, lost;
  std::vector<graph::Alignment> alignments;
  std::vector<ProximityMatch> matches;
  std::vector<AgentId> heard;
  std::vector<std::pair<AgentId, NodeId>> requests;
  std::vector<std::pair<NodeId, Bytes>> clouds;
  bool had_room = false;
};

}  // namespace fleetmap::exchange
