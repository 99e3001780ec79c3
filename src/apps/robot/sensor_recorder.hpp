#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "record_options.hpp"

namespace fleetmap::apps {

/// Durability with which the topic is published (qos/onboard.xml).
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
  /// The reason why the bag ends before its time; empty if it does not.
  const std::string& problem() const { return problem_; }

 private:
  void stop(const std::string& problem);

  SensorRecorder(recording::BagWriter writer, const agent::SensorTopics& topics, bool outputs, bus::Bus& bus);

  recording::BagWriter writer_;
  std::string problem_;
  std::vector<bus::Handle> subscriptions_;
};

}  // namespace fleetmap::apps
