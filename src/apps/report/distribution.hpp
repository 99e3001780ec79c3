#pragma once

#include <cstddef>
#include <vector>

namespace fleetmap::apps {

/// Minimum, mean, median, 99th percentile and maximum, and their number.
struct Distribution {
  std::size_t count = 0;
  double min = 0.0, mean = 0.0, p50 = 0.0, p99 = 0.0, max = 0.0;
};
Distribution distribution(std::vector<double> values);

}  // namespace fleetmap::apps
