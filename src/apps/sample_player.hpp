#pragma once

#include <array>
#include <optional>
#include <variant>
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

/// When samples are played: at their stamps, but a sensor whose clock was set back goes on without a break.
class PlayTimes {
 public:
  /// Samples in the order in which they are played.
  Stamp of(const recording::Sample& sample);

 private:
  struct Clock {
    std::optional<Stamp> last;
    Duration set_back{};
  };
  std::array<Clock, std::variant_size_v<recording::Sample>> clocks_;
};

}  // namespace fleetmap::apps
