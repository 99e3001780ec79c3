#include "bag_topics.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::recording {
namespace {

constexpr char kNone[] = "none";
constexpr char kTransforms[] = "tf2_msgs/msg/TFMessage";

/// One kind of topic: its config key, its type and our own name for it.
struct Role {
  const char* key;
  const char* type;
  const char* own_name;
  std::string Topics::*wanted;
  Kind kind;
  bool needed;
};
const Role kRoles[] = {
    {"recording.topics.points", "sensor_msgs/msg/PointCloud2", "/points", &Topics::points, Kind::kScan, true},
    {"recording.topics.imu", "sensor_msgs/msg/Imu", "/imu", &Topics::imu, Kind::kImu, false},
    {"recording.topics.fix", "sensor_msgs/msg/NavSatFix", "/fix", &Topics::fix, Kind::kFix, false},
    {"recording.topics.wheel", "nav_msgs/msg/Odometry", "/wheel_odometry", &Topics::wheel, Kind::kWheel,
     false},
};

/// Read for the points where there are no clouds.
const Role kPackets{"recording.topics.points",
                    "velodyne_msgs/msg/VelodyneScan",
                    "/velodyne_packets",
                    &Topics::points,
                    Kind::kPackets,
                    true};

std::string list(const std::vector<BagTopic>& topics) {
  std::string out;
  for (const BagTopic& topic : topics) append_to_list(out, topic.name + " (" + topic.type + ")");
  return out.empty() ? "none" : out;
}

std::vector<BagTopic> of_type(const std::vector<BagTopic>& topics, const char* type) {
  std::vector<BagTopic> found;
  std::ranges::copy_if(topics, std::back_inserter(found),
                       [&](const BagTopic& topic) { return topic.type == type; });
  return found;
}

/// Whether the points come from packets: those that are wanted, or all that there is.
bool takes_packets(const std::vector<BagTopic>& topics, const Role& clouds, const std::string& wanted,
                   const std::string& bag) {
  const std::vector<BagTopic> packets = of_type(topics, kPackets.type);
  if (!wanted.empty())
    return std::ranges::any_of(packets, [&](const BagTopic& topic) { return topic.name == wanted; });
  const bool has_clouds = !of_type(topics, clouds.type).empty();
  if (has_clouds && !packets.empty())
    spdlog::info("{}: holds clouds and packets of a LiDAR; the clouds are taken, not {}", bag, list(packets));
  return !has_clouds && !packets.empty();
}

Result<std::string> select(const Role& role, const std::vector<BagTopic>& topics, const std::string& wanted,
                           const std::string& bag) {
  const std::vector<BagTopic> candidates = of_type(topics, role.type);
  const auto named = [&](const std::string& name) {
    return std::ranges::any_of(candidates, [&](const BagTopic& topic) { return topic.name == name; });
  };
  if (!wanted.empty()) {
    if (named(wanted)) return wanted;
    return failure(bag + ": " + role.key + " is '" + wanted + "', but the bag has no such topic of type " +
                   role.type + "; it has: " + list(topics));
  }
  if (candidates.size() == 1) return candidates.front().name;
  if (named(role.own_name)) return std::string(role.own_name);
  if (candidates.empty() && !role.needed) return std::string();
  if (candidates.empty()) {
    return failure(bag + ": no topic of type " + role.type + "; the bag has: " + list(topics));
  }
  return failure(bag + ": several topics of type " + role.type + ": " + list(candidates) +
                 "; choose one with " + role.key + (role.needed ? "" : " (or none)"));
}

}  // namespace

Result<std::map<std::string, Kind>> select_topics(const std::vector<BagTopic>& topics, const Topics& wanted,
                                                  const std::string& bag, bool scans_needed) {
  std::map<std::string, Kind> chosen;
  for (Role role : kRoles) {
    if (role.kind == Kind::kScan && takes_packets(topics, role, wanted.points, bag)) role = kPackets;
    role.needed = role.needed && scans_needed;
    if (wanted.*role.wanted == kNone && !role.needed) continue;
    const auto name = select(role, topics, wanted.*role.wanted, bag);
    if (!name) return tl::unexpected(name.error());
    if (!name->empty()) chosen.emplace(*name, role.kind);
  }
  for (const BagTopic& topic : of_type(topics, kTransforms)) {
    if (topic.name.ends_with("/tf_static")) chosen.emplace(topic.name, Kind::kTransforms);
  }
  return chosen;
}

}  // namespace fleetmap::recording
