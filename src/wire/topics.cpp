#include "fleetmap/wire/topics.hpp"

#include "type_names.hpp"

namespace fleetmap::wire::topics {

using bus::Link;

bus::Topic points() { return {Link::kOnboard, "rt/points", type_name::kPointCloud2, "sensor"}; }
bus::Topic imu() { return {Link::kOnboard, "rt/imu", type_name::kImu, "sensor"}; }
bus::Topic fix() { return {Link::kOnboard, "rt/fix", type_name::kNavSatFix, "sensor"}; }
bus::Topic wheel_odometry() { return {Link::kOnboard, "rt/wheel_odometry", type_name::kOdometry, "sensor"}; }
bus::Topic odometry() { return {Link::kOnboard, "rt/odometry", type_name::kOdometry, "state"}; }
bus::Topic global_pose() { return {Link::kOnboard, "fleetmap/global_pose", type_name::kGlobalPose, "state"}; }
bus::Topic corrected_pose() {
  return {Link::kOnboard, "fleetmap/corrected_pose", type_name::kGlobalPose, "state"};
}
bus::Topic guide_pose() { return {Link::kOnboard, "fleetmap/guide_pose", type_name::kGlobalPose, "state"}; }
bus::Topic cmd_vel() { return {Link::kOnboard, "rt/cmd_vel", type_name::kTwist, "state"}; }

bus::Topic battery() { return {Link::kOnboard, "rt/battery_state", type_name::kBatteryState, "sensor"}; }

bus::Topic hold() { return topic_of(exchange::Message(exchange::Hold{})); }
bus::Topic hold_onboard() { return {Link::kOnboard, "fleetmap/hold", type_name::kHold, "state"}; }

}  // namespace fleetmap::wire::topics

namespace fleetmap::wire {
namespace {

using bus::Link;
using bus::Topic;
using exchange::Reach;

/// The topics of one kind of message.
struct Kind {
  const char* name;
  const char* type;
  bool large = false;  ///< one of many pieces
};

struct KindOf {
  Kind operator()(const graph::Node&) const { return {"fleetmap/node", type_name::kNode}; }
  Kind operator()(const graph::Alignment&) const { return {"fleetmap/alignment", type_name::kAlignment}; }
  Kind operator()(const exchange::Digest&) const { return {"fleetmap/digest", type_name::kDigest}; }
  Kind operator()(const exchange::AgentStatus&) const { return {"fleetmap/status", type_name::kAgentStatus}; }
  Kind operator()(const exchange::MissionReport&) const {
    return {"fleetmap/mission_report", type_name::kMissionReport};
  }
  Kind operator()(const exchange::Hold&) const { return {"fleetmap/hold", type_name::kHold}; }
  Kind operator()(const exchange::ProximityMatch&) const {
    return {"fleetmap/proximity_match", type_name::kProximityMatch};
  }
  Kind operator()(const exchange::CloudRequest&) const {
    return {"fleetmap/cloud_request", type_name::kCloudRequest};
  }
  Kind operator()(const exchange::ItemRequest&) const {
    return {"fleetmap/item_request", type_name::kItemRequest};
  }
  Kind operator()(const exchange::CloudFragment&) const {
    return {"fleetmap/cloud_fragment", type_name::kCloudFragment, true};
  }
  Kind operator()(const exchange::SubmapDigest&) const {
    return {"fleetmap/submap_digest", type_name::kSubmapDigest};
  }
  Kind operator()(const exchange::SubmapRequest&) const {
    return {"fleetmap/submap_request", type_name::kSubmapRequest};
  }
  Kind operator()(const exchange::SubmapChunk&) const {
    return {"fleetmap/submap_chunk", type_name::kSubmapChunk, true};
  }
};

Topic topic(const Kind& kind, Reach reach, const std::optional<AgentId>& to) {
  const std::string name = to ? std::string(kind.name) + "/" + to->str() : kind.name;
  if (reach == Reach::kLongRange) return {Link::kLongRange, name, kind.type, kind.large ? "cloud" : "small"};
  return {Link::kShortRange, name, kind.type, kind.large ? "bulk" : "control"};
}

Kind kind_of(const exchange::Message& message) { return std::visit(KindOf{}, message); }

/// Adds the topics on which messages like `example` arrive.
void add_inbox(std::vector<Topic>& topics, const exchange::Message& example, const AgentId& self) {
  const bool to_all = !exchange::recipient_of(example);
  const bool over_radio = exchange::usual_reach(example) == Reach::kLongRange;
  const bool to_one = !to_all || exchange::may_go_one_by_one(example);
  for (const Reach reach : {Reach::kLongRange, Reach::kShortRange}) {
    if (reach == Reach::kLongRange && !over_radio) continue;
    if (to_all) topics.push_back(topic(kind_of(example), reach, std::nullopt));
    if (to_one) topics.push_back(topic(kind_of(example), reach, self));
  }
}

template <std::size_t... Index>
std::vector<Topic> inbox(const AgentId& self, std::index_sequence<Index...>) {
  std::vector<Topic> topics;
  (add_inbox(topics, exchange::Message(std::in_place_index<Index>), self), ...);
  return topics;
}

}  // namespace

Topic topic_of(const exchange::Outgoing& outgoing) {
  return topic(kind_of(outgoing.message), outgoing.reach, outgoing.to);
}

Topic topic_of(const exchange::Message& message) {
  return topic(kind_of(message), exchange::usual_reach(message), exchange::recipient_of(message));
}

Reach reach_of(Link link) { return link == Link::kShortRange ? Reach::kShortRange : Reach::kLongRange; }

std::vector<Topic> inbox_topics(const AgentId& self) {
  return inbox(self, std::make_index_sequence<std::variant_size_v<exchange::Message>>());
}

}  // namespace fleetmap::wire
