#include "fleetmap/fleet_codec/topics.hpp"

#include "type_names.hpp"

namespace fleetmap::fleet_codec::topics {

using bus::Link;

bus::Topic global_pose() { return {Link::kOnboard, "fleetmap/global_pose", type_name::kGlobalPose, "state"}; }
bus::Topic corrected_pose() {
  return {Link::kOnboard, "fleetmap/corrected_pose", type_name::kGlobalPose, "state"};
}
bus::Topic guide_pose() { return {Link::kOnboard, "fleetmap/guide_pose", type_name::kGlobalPose, "state"}; }
bus::Topic hold() { return topic_of(messages::Message(messages::Hold{})); }
bus::Topic hold_onboard() { return {Link::kOnboard, "fleetmap/hold", type_name::kHold, "state"}; }

}  // namespace fleetmap::fleet_codec::topics

namespace fleetmap::fleet_codec {
namespace {

using bus::Link;
using bus::Topic;
using messages::Reach;

/// The topics of one kind of message.
struct Kind {
  const char* name;
  const char* type;
  bool large = false;  ///< one of many pieces
};

struct KindOf {
  Kind operator()(const graph::Node&) const { return {"fleetmap/node", type_name::kNode}; }
  Kind operator()(const graph::Alignment&) const { return {"fleetmap/alignment", type_name::kAlignment}; }
  Kind operator()(const messages::Digest&) const { return {"fleetmap/digest", type_name::kDigest}; }
  Kind operator()(const messages::AgentStatus&) const { return {"fleetmap/status", type_name::kAgentStatus}; }
  Kind operator()(const messages::MissionReport&) const {
    return {"fleetmap/mission_report", type_name::kMissionReport};
  }
  Kind operator()(const messages::Hold&) const { return {"fleetmap/hold", type_name::kHold}; }
  Kind operator()(const messages::ProximityMatch&) const {
    return {"fleetmap/proximity_match", type_name::kProximityMatch};
  }
  Kind operator()(const messages::CloudRequest&) const {
    return {"fleetmap/cloud_request", type_name::kCloudRequest};
  }
  Kind operator()(const messages::ItemRequest&) const {
    return {"fleetmap/item_request", type_name::kItemRequest};
  }
  Kind operator()(const messages::CloudFragment&) const {
    return {"fleetmap/cloud_fragment", type_name::kCloudFragment, true};
  }
  Kind operator()(const messages::SubmapDigest&) const {
    return {"fleetmap/submap_digest", type_name::kSubmapDigest};
  }
  Kind operator()(const messages::SubmapRequest&) const {
    return {"fleetmap/submap_request", type_name::kSubmapRequest};
  }
  Kind operator()(const messages::SubmapChunk&) const {
    return {"fleetmap/submap_chunk", type_name::kSubmapChunk, true};
  }
};

Topic topic(const Kind& kind, Reach reach, const std::optional<AgentId>& to) {
  const std::string name = to ? std::string(kind.name) + "/" + to->str() : kind.name;
  if (reach == Reach::kLongRange) return {Link::kLongRange, name, kind.type, kind.large ? "cloud" : "small"};
  return {Link::kShortRange, name, kind.type, kind.large ? "bulk" : "control"};
}

Kind kind_of(const messages::Message& message) { return std::visit(KindOf{}, message); }

/// Adds the topics on which messages like `example` arrive.
void add_inbox(std::vector<Topic>& topics, const messages::Message& example, const AgentId& self) {
  const bool to_all = !messages::recipient_of(example);
  const bool over_radio = messages::usual_reach(example) == Reach::kLongRange;
  const bool to_one = !to_all || messages::may_go_one_by_one(example);
  for (const Reach reach : {Reach::kLongRange, Reach::kShortRange}) {
    if (reach == Reach::kLongRange && !over_radio) continue;
    if (to_all) topics.push_back(topic(kind_of(example), reach, std::nullopt));
    if (to_one) topics.push_back(topic(kind_of(example), reach, self));
  }
}

template <std::size_t... Index>
std::vector<Topic> inbox(const AgentId& self, std::index_sequence<Index...>) {
  std::vector<Topic> topics;
  (add_inbox(topics, messages::Message(std::in_place_index<Index>), self), ...);
  return topics;
}

}  // namespace

Topic topic_of(const messages::Outgoing& outgoing) {
  return topic(kind_of(outgoing.message), outgoing.reach, outgoing.to);
}

Topic topic_of(const messages::Message& message) {
  return topic(kind_of(message), messages::usual_reach(message), messages::recipient_of(message));
}

Reach reach_of(Link link) { return link == Link::kShortRange ? Reach::kShortRange : Reach::kLongRange; }

std::vector<Topic> inbox_topics(const AgentId& self) {
  return inbox(self, std::make_index_sequence<std::variant_size_v<messages::Message>>());
}

}  // namespace fleetmap::fleet_codec
