#pragma once

#include <chrono>
#include <cstddef>

namespace fleetmap::monitor::foxglove {

struct FeedConfig {
  std::size_t map_points = 300'000;
  std::chrono::milliseconds map_period{5'000};
};

}  // namespace fleetmap::monitor::foxglove
