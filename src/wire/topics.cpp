#include "fleetmap/wire/topics.hpp"

#include "type_names.hpp"

namespace fleetmap::wire::topics {
namespace {

using bus::Link;

bus::Topic to_one(Link link, const char* stem, const AgentId& recipient, const char* type,
                  const char* profile) {
  return {link, std::string(stem) + "/" + recipient.str(), type, profile};
}

}  // namespace

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

bus::Topic node() { return {Link::kLongRange, "fleetmap/node", type_name::kNode, "small"}; }
bus::Topic alignment() { return {Link::kLongRange, "fleetmap/alignment", type_name::kAlignment, "small"}; }
bus::Topic digest() { return {Link::kLongRange, "fleetmap/digest", type_name::kDigest, "small"}; }
bus::Topic status() { return {Link::kLongRange, "fleetmap/status", type_name::kAgentStatus, "small"}; }

bus::Topic mission_report() {
  return {Link::kLongRange, "fleetmap/mission_report", type_name::kMissionReport, "small"};
}

bus::Topic hold() { return {Link::kLongRange, "fleetmap/hold", type_name::kHold, "small"}; }
bus::Topic hold_onboard() { return {Link::kOnboard, "fleetmap/hold", type_name::kHold, "state"}; }

bus::Topic proximity_match(const AgentId& recipient) {
  return to_one(Link::kLongRange, "fleetmap/proximity_match", recipient, type_name::kProximityMatch, "small");
}
bus::Topic cloud_request(const AgentId& recipient) {
  return to_one(Link::kLongRange, "fleetmap/cloud_request", recipient, type_name::kCloudRequest, "small");
}
bus::Topic item_request(const AgentId& recipient) {
  return to_one(Link::kLongRange, "fleetmap/item_request", recipient, type_name::kItemRequest, "small");
}
bus::Topic cloud_fragment(const AgentId& recipient) {
  return to_one(Link::kLongRange, "fleetmap/cloud_fragment", recipient, type_name::kCloudFragment, "cloud");
}

bus::Topic submap_digest() {
  return {Link::kShortRange, "fleetmap/submap_digest", type_name::kSubmapDigest, "control"};
}
bus::Topic submap_request(const AgentId& recipient) {
  return to_one(Link::kShortRange, "fleetmap/submap_request", recipient, type_name::kSubmapRequest,
                "control");
}
bus::Topic submap_chunk(const AgentId& recipient) {
  return to_one(Link::kShortRange, "fleetmap/submap_chunk", recipient, type_name::kSubmapChunk, "bulk");
}

}  // namespace fleetmap::wire::topics

namespace fleetmap::wire {
namespace {

struct TopicOf {
  bus::Topic operator()(const graph::Node&) const { return topics::node(); }
  bus::Topic operator()(const graph::Alignment&) const { return topics::alignment(); }
  bus::Topic operator()(const exchange::Digest&) const { return topics::digest(); }
  bus::Topic operator()(const exchange::AgentStatus&) const { return topics::status(); }
  bus::Topic operator()(const exchange::MissionReport&) const { return topics::mission_report(); }
  bus::Topic operator()(const exchange::Hold&) const { return topics::hold(); }
  bus::Topic operator()(const exchange::SubmapDigest&) const { return topics::submap_digest(); }
  bus::Topic operator()(const exchange::ProximityMatch& m) const { return topics::proximity_match(m.to); }
  bus::Topic operator()(const exchange::CloudRequest& m) const { return topics::cloud_request(m.to); }
  bus::Topic operator()(const exchange::ItemRequest& m) const { return topics::item_request(m.to); }
  bus::Topic operator()(const exchange::CloudFragment& m) const { return topics::cloud_fragment(m.to); }
  bus::Topic operator()(const exchange::SubmapRequest& m) const { return topics::submap_request(m.to); }
  bus::Topic operator()(const exchange::SubmapChunk& m) const { return topics::submap_chunk(m.to); }
};

}  // namespace

bus::Topic topic_of(const exchange::Message& message) { return std::visit(TopicOf{}, message); }

std::vector<bus::Topic> inbox_topics(const AgentId& self) {
  return {topics::node(),
          topics::alignment(),
          topics::digest(),
          topics::status(),
          topics::mission_report(),
          topics::hold(),
          topics::proximity_match(self),
          topics::cloud_request(self),
          topics::item_request(self),
          topics::cloud_fragment(self),
          topics::submap_digest(),
          topics::submap_request(self),
          topics::submap_chunk(self)};
}

}  // namespace fleetmap::wire
