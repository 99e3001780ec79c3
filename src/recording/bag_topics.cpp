#include "bag_topics.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <string_view>

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

/// Read for the points where there are no clouds, the first that a bag has.
const Role kInsteadOfClouds[] = {
    {"recording.topics.points", "livox_ros_driver2/msg/CustomMsg", "/livox/lidar", &Topics::points,
     Kind::kLivox, true},
    {"recording.topics.points", "livox_ros_driver/msg/CustomMsg", "/livox/lidar", &Topics::points,
     Kind::kLivox, true},
    {"recording.topics.points", "livox_interfaces/msg/CustomMsg", "/livox/lidar", &Topics::points,
     Kind::kLivox, true},
    {"recording.topics.points", "velodyne_msgs/msg/VelodyneScan", "/velodyne_packets", &Topics::points,
     Kind::kPackets, true},
};

/// Written by this program: topics below /fleetmap, and the odometry beside them.
bool is_own_output(const BagTopic& topic, const std::vector<BagTopic>& topics) {
  constexpr std::string_view kOwn = "/fleetmap/";
  if (topic.name.starts_with(kOwn)) return true;
  return topic.name == "/odometry" &&
         std::ranges::any_of(topics, [&](const BagTopic& other) { return other.name.starts_with(kOwn); });
}

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

std::vector<BagTopic> sensors_of_type(const std::vector<BagTopic>& topics, const char* type) {
  std::vector<BagTopic> found = of_type(topics, type);
  std::erase_if(found, [&](const BagTopic& topic) { return is_own_output(topic, topics); });
  return found;
}

/// The type that the points are read from: that of the topic that is wanted, or the first that there is.
Role role_of_points(const Role& clouds, const std::vector<BagTopic>& topics, const std::string& wanted,
                    const std::string& bag) {
  const bool has_clouds = !sensors_of_type(topics, clouds.type).empty();
  const Role* selected = has_clouds ? &clouds : nullptr;
  for (const Role& role : kInsteadOfClouds) {
    const std::vector<BagTopic> candidates = of_type(topics, role.type);
    if (candidates.empty()) continue;
    if (std::ranges::find(candidates, wanted, &BagTopic::name) != candidates.end()) return role;
    if (selected == nullptr) {
      selected = &role;
    } else if (wanted.empty()) {
      spdlog::info("{}: holds points in several forms; the {} are taken, not {}", bag,
                   selected == &clouds ? "clouds" : selected->type, list(candidates));
    }
  }
  return selected != nullptr && wanted.empty() ? *selected : clouds;
}

/// Names the types that points are read from, for a bag that has none of them, and the remedy.
std::string no_points(const char* clouds, const std::vector<BagTopic>& topics) {
  std::string text = "no topic of points, of type ";
  text += clouds;
  for (const Role& role : kInsteadOfClouds) {
    text += &role == std::prev(std::end(kInsteadOfClouds)) ? " or " : ", ";
    text += role.type;
  }
  return text + "; the bag has: " + list(topics) +
         ". The LiDAR was off, or its topic or type is another: record its driver's topic of one of these "
         "types (recording.topics.points names it)";
}

Result<std::string> select(const Role& role, const std::vector<BagTopic>& topics, const std::string& wanted,
                           const std::string& bag) {
  const auto named = [](const std::vector<BagTopic>& among, const std::string& name) {
    return std::ranges::find(among, name, &BagTopic::name) != among.end();
  };
  if (!wanted.empty()) {
    if (named(of_type(topics, role.type), wanted)) return wanted;
    return failure(bag + ": " + role.key + " is '" + wanted + "', but the bag has no such topic of type " +
                   role.type + "; it has: " + list(topics));
  }
  const std::vector<BagTopic> candidates = sensors_of_type(topics, role.type);
  if (candidates.size() == 1) return candidates.front().name;
  if (named(candidates, role.own_name)) return std::string(role.own_name);
  if (candidates.empty() && !role.needed) return std::string();
  if (candidates.empty()) return failure(bag + ": " + no_points(role.type, topics));
  return failure(bag + ": several topics of type " + role.type + ": " + list(candidates) +
                 "; choose one with " + role.key + (role.needed ? "" : " (or none)"));
}

}  // namespace

Result<std::map<std::string, Kind>> select_topics(const std::vector<BagTopic>& topics, const Topics& wanted,
                                                  const std::string& bag, bool scans_needed) {
  std::map<std::string, Kind> selected;
  for (Role role : kRoles) {
    if (role.kind == Kind::kScan) role = role_of_points(role, topics, wanted.points, bag);
    role.needed = role.needed && scans_needed;
    if (wanted.*role.wanted == kNone && !role.needed) continue;
    const auto name = select(role, topics, wanted.*role.wanted, bag);
    if (!name) return tl::unexpected(name.error());
    if (!name->empty()) selected.emplace(*name, role.kind);
  }
  for (const BagTopic& topic : of_type(topics, kTransforms)) {
    if (topic.name.ends_with("/tf_static")) selected.emplace(topic.name, Kind::kTransforms);
  }
  return selected;
}

}  // namespace fleetmap::recording
