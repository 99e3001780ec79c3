// config/rviz/fleetmap.rviz against the topics that a robot publishes.
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap {
namespace {

namespace topics = ros_codec::topics;

YAML::Node displays() {
  return YAML::LoadFile(std::string(FLEETMAP_SOURCE_DIR) +
                        "/config/rviz/fleetmap.rviz")["Visualization Manager"]["Displays"];
}

std::vector<bus::Topic> published() {
  std::vector<bus::Topic> all = topics::outputs();
  all.push_back(topics::points());
  return all;
}

const bus::Topic* find(const std::vector<bus::Topic>& all, const std::string& name) {
  const auto found = std::ranges::find(all, "rt" + name, &bus::Topic::name);
  return found == all.end() ? nullptr : &*found;
}

TEST(RvizLayout, EveryDisplayHearsATopicOfItsType) {
  const std::map<std::string, std::string> kTypes = {
      {"rviz_default_plugins/PointCloud2", "PointCloud2_"},
      {"rviz_default_plugins/MarkerArray", "MarkerArray_"},
      {"rviz_default_plugins/Path", "Path_"},
      {"rviz_default_plugins/PoseWithCovariance", "PoseWithCovarianceStamped_"},
      {"rviz_default_plugins/Odometry", "Odometry_"}};
  const std::vector<bus::Topic> all = published();
  for (const YAML::Node& display : displays()) {
    if (!display["Topic"]) continue;
    const auto name = display["Topic"]["Value"].as<std::string>();
    const bus::Topic* topic = find(all, name);
    ASSERT_NE(topic, nullptr) << name;
    const auto type = kTypes.find(display["Class"].as<std::string>());
    ASSERT_NE(type, kTypes.end()) << name;
    EXPECT_THAT(topic->type, ::testing::EndsWith("::" + type->second)) << name;
    // A reader that asks for what is kept hears nothing of a writer of sensor data that is best effort.
    const bool reliable = display["Topic"]["Reliability Policy"].as<std::string>() == "Reliable";
    EXPECT_EQ(reliable, topic->profile != "sensor") << name;
  }
}

TEST(RvizLayout, ShowsAllThatIsLatchedFromItsBeginning) {
  const YAML::Node shown = displays();
  for (const bus::Topic& topic : topics::outputs()) {
    if (topic.profile != "latched" || topic.name == topics::tf_static().name) continue;
    const bool found = std::any_of(shown.begin(), shown.end(), [&](const YAML::Node& display) {
      return display["Topic"] && "rt" + display["Topic"]["Value"].as<std::string>() == topic.name &&
             display["Topic"]["Durability Policy"].as<std::string>() == "Transient Local";
    });
    EXPECT_TRUE(found) << topic.name;
  }
}

}  // namespace
}  // namespace fleetmap
