#include "sample_player.hpp"

#include "fleetmap/wire/sensors.hpp"
#include "fleetmap/wire/topics.hpp"

namespace fleetmap::apps {
namespace {

bus::Topic topic_of(const sensor::Scan&) { return wire::topics::points(); }
bus::Topic topic_of(const sensor::Imu&) { return wire::topics::imu(); }
bus::Topic topic_of(const sensor::Fix&) { return wire::topics::fix(); }
bus::Topic topic_of(const sensor::Wheel&) { return wire::topics::wheel_odometry(); }

}  // namespace

EncodedSample encode(const recording::Sample& sample) {
  return std::visit([](const auto& s) { return EncodedSample{topic_of(s), wire::encode(s)}; }, sample);
}

}  // namespace fleetmap::apps
