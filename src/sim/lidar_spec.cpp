#include "fleetmap/sim/lidar_spec.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spec_rules.hpp"

namespace fleetmap::sim {
namespace {

constexpr int kMaxRays = 4'000'000;  // a scan

}  // namespace

Status LidarSpec::validate() const {
  if (pattern == FiringPattern::kSpinning) {
    if (vertical_angles.empty() || vertical_angles.size() > 1024) {
      return failure("vertical_angles: a spinning LiDAR needs 1 to 1024 rings");
    }
    for (const double angle : vertical_angles) {
      if (!(std::abs(angle) < std::numbers::pi / 2)) {
        return failure("vertical_angles: each must lie between -90 and 90 degrees");
      }
    }
    if (columns < 1 || columns > kMaxRays / static_cast<int>(vertical_angles.size())) {
      return failure("columns: must be at least 1, and at most 4 million rays a scan");
    }
  } else {
    if (rays < 1 || rays > kMaxRays) return failure("rays: must be 1 to 4 million a scan");
    if (!(field_of_view > 0.0 && field_of_view <= 2.0 * std::numbers::pi)) {
      return failure("field_of_view: must be above 0 and at most 360 degrees");
    }
  }
  return first_failure({
      within("rate", rate, 0.1, 100.0, "Hz"),
      within("min_range", min_range, 0.0, 1e3, "m"),
      max_range > min_range ? within("max_range", max_range, 0.0, 1e4, "m")
                            : failure("max_range: must be greater than min_range"),
      within("range_noise", range_noise, 0.0, 10.0, "m"),
      within("beam_divergence", beam_divergence, 0.0, 0.2, "rad"),
      within("dropout", dropout, 0.0, 1.0, "(a share)"),
      within("glass_grazing", glass_grazing, 0.0, std::numbers::pi / 2, "rad"),
  });
}

LidarSpec vlp16_spec() {
  LidarSpec spec;
  for (int ring = 0; ring < 16; ++ring)
    spec.vertical_angles.push_back((2.0 * ring - 15.0) * std::numbers::pi / 180.0);
  spec.fixed_firing_rate = true;
  return spec;
}

LidarSpec at_rate(LidarSpec spec, double rate) {
  if (spec.fixed_firing_rate && rate > 0.0) {
    const double factor = spec.rate / rate;
    spec.columns = static_cast<int>(std::lround(std::clamp(spec.columns * factor, 1.0, 1.0 * kMaxRays)));
    spec.rays = static_cast<int>(std::lround(std::clamp(spec.rays * factor, 1.0, 1.0 * kMaxRays)));
  }
  spec.rate = rate;
  return spec;
}

}  // namespace fleetmap::sim
