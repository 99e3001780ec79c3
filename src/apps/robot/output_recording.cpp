#include "output_recording.hpp"

#include <utility>

#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::apps {
namespace {

/// Work is done at once: a lane's time would change the run that is recorded.
RosPublisher::Edges edges() {
  return {[](const bus::Topic&) { return std::size_t{1}; },
          [](const std::function<void()>& work, const std::function<void()>& done) {
            work();
            done();
            return true;
          },
          {}};
}

}  // namespace

OutputRecording::OutputRecording(agent::Agent& agent, bus::Bus& bus,
                                 const ros_output::RosOutputConfig& config, Write write)
    : write_(std::move(write)), publisher_(agent, bus, config, edges()) {
  for (const bus::Topic& topic : ros_codec::topics::outputs())
    subscriptions_.push_back(bus.subscribe(topic, [this, topic](const Bytes& cdr) { write_(topic, cdr); }));
}

}  // namespace fleetmap::apps
