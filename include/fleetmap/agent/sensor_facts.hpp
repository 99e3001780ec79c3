#pragma once

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::agent {

/// Facts on the sensors that maps of the store depend on: the LiDAR's mount, and heights above sea level.
class SensorFacts {
 public:
  /// Stores each once, as soon as it is known. Fails with the store; what failed is not tried again.
  Status keep(store::Store& store, const Perception& perception);

 private:
  bool mount_kept_ = false, heights_kept_ = false;
};

}  // namespace fleetmap::agent
