#pragma once

#include <memory>
#include <vector>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "record_options.hpp"

namespace fleetmap::apps {

/// Durability with which the topic is published here.
recording::Durability durability_of(const bus::Topic& topic);

/// Writes what arrives on the sensor topics, and what the robot publishes for ROS 2, into a bag.
class SensorRecorder {
 public:
  /// `outputs`: the robot publishes them. In its folder, or with a number behind it if it holds a bag of an
  /// earlier start.
  static Result<std::unique_ptr<SensorRecorder>> create(const RecordOptions& options,
                                                        const agent::SensorTopics& topics, bool outputs,
                                                        bus::Bus& bus);
  Status close();

 private:
  SensorRecorder(recording::BagWriter writer, const agent::SensorTopics& topics, bool outputs, bus::Bus& bus);

  recording::BagWriter writer_;
  bool failed_ = false;
  std::vector<bus::Handle> subscriptions_;
};

}  // namespace fleetmap::apps
