#pragma once

#include <vector>

#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::sensor {

/// Samples that the bytes of a device complete.
struct DeviceSamples {
  std::vector<Imu> imu;
  std::vector<Fix> fixes;
};

}  // namespace fleetmap::sensor
