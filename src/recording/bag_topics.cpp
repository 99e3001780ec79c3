#include "bag_topics.hpp"

#include <algorithm>

namespace fleetmap::recording {
namespace {

constexpr char kNone[] = "none";

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

std::string list(const std::vector<BagTopic>& topics) {
  std::string out;
  for (const BagTopic& topic : topics)
    out += (out.empty() ? "" : ", ") + topic.name + " (" + topic.type + ")";
  return out.empty() ? "none" : out;
}

Result<std::string> select(const Role& role, const std::vector<BagTopic>& topics, const std::string& wanted,
                           const std::string& bag) {
  std::vector<BagTopic> candidates;
  std::ranges::copy_if(topics, std::back_inserter(candidates),
                       [&](const BagTopic& topic) { return topic.type == role.type; });
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
    role.needed = role.needed && scans_needed;
    if (wanted.*role.wanted == kNone && !role.needed) continue;
    const auto name = select(role, topics, wanted.*role.wanted, bag);
    if (!name) return tl::unexpected(name.error());
    if (!name->empty()) chosen.emplace(*name, role.kind);
  }
  return chosen;
}

}  // namespace fleetmap::recording
