#pragma once

#include <vector>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// The onboard topics of scans, IMU, fixes and wheel odometry, in this order.
std::vector<bus::Topic> sensor_topics(const agent::SensorTopics& names);

/// A sample as it goes onto a robot's onboard link.
struct EncodedSample {
  bus::Topic topic;
  Bytes cdr;
};
EncodedSample encode(const recording::Sample& sample, const agent::SensorTopics& names);

/// The mounts that a recording states, from base_link to the frame_ids of encode().
std::vector<sensor::FrameTransform> mounts_of(const sensor::SensorFrames& frames);

}  // namespace fleetmap::apps
