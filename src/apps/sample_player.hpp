#pragma once

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// A sample as it goes onto a robot's onboard link.
struct EncodedSample {
  bus::Topic topic;
  Bytes cdr;
};
EncodedSample encode(const recording::Sample& sample);

}  // namespace fleetmap::apps
