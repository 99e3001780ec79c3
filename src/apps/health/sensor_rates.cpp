#include "sensor_rates.hpp"

namespace fleetmap::apps {

std::vector<monitor::SensorNow> SensorRates::add(const agent::Perception& perception, Stamp now) {
  const agent::PerceptionCounters& counters = perception.counters();
  const std::array<std::uint64_t, sensor::kSources> samples{counters.scans, counters.imu, counters.fixes,
                                                            counters.wheel};
  const double elapsed = last_ ? to_seconds(now - *last_) : 0.0;
  std::vector<monitor::SensorNow> sensors;
  for (std::size_t k = 0; k < sensor::kSources; ++k) {
    const auto source = static_cast<sensor::Source>(k);
    const auto more = static_cast<double>(samples[k] - samples_[k]);
    if (more > 0.0) heard_[k] = now;
    sensors.push_back({sensor::to_string(source), samples[k], elapsed > 0.0 ? more / elapsed : 0.0,
                       perception.clock_offsets().behind(source), perception.clock_offsets().slow_ppm(source),
                       heard_[k] ? to_seconds(now - *heard_[k]) : 0.0});
  }
  samples_ = samples;
  last_ = now;
  return sensors;
}

}  // namespace fleetmap::apps
