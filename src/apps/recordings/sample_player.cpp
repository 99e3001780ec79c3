#include "sample_player.hpp"

#include <utility>

#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::apps {

std::vector<bus::Topic> sensor_topics(const agent::SensorTopics& names) {
  std::vector<bus::Topic> topics{ros_codec::topics::points(), ros_codec::topics::imu(),
                                 ros_codec::topics::fix(), ros_codec::topics::wheel_odometry()};
  topics[0].name = names.points;
  topics[0].type = ros_codec::dds_name(names.points_type);
  topics[1].name = names.imu;
  topics[2].name = names.fix;
  topics[3].name = names.wheel;
  return topics;
}

EncodedSample encode(const recording::Sample& sample, const agent::SensorTopics& names) {
  // The order of the variant is that of sensor_topics().
  const bus::Topic topic = sensor_topics(names)[sample.index()];
  if (const auto* scan = std::get_if<sensor::Scan>(&sample))
    return {topic, ros_codec::encode_points(*scan, names.points_type)};
  return {topic, std::visit([](const auto& s) { return ros_codec::encode(s); }, sample)};
}

std::vector<sensor::FrameTransform> mounts_of(const sensor::SensorFrames& frames) {
  std::vector<sensor::FrameTransform> mounts;
  for (const auto& [id, played_as] : {std::pair(frames.ids[0], "lidar"), std::pair(frames.ids[1], "imu"),
                                      std::pair(frames.ids[2], "gps")}) {
    if (const auto T = frames.tree.find("base_link", id); T && !id.empty() && !frames.tree.empty())
      mounts.push_back({"base_link", played_as, T->translation(), Eigen::Quaterniond(T->linear())});
  }
  return mounts;
}

}  // namespace fleetmap::apps
