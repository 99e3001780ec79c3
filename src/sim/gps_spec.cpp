#include "fleetmap/sim/gps_spec.hpp"

#include "spec_rules.hpp"

namespace fleetmap::sim {

Status GpsSpec::validate() const {
  for (const GpsOutage& outage : outages) {
    if (!(outage.from >= 0.0 && outage.until > outage.from)) {
      return failure("outages: each must have 0 <= from < until, in s since the start");
    }
  }
  return first_failure({
      within("rate", rate, 0.05, 100.0, "Hz"),
      within("white_sigma", white_sigma, 0.0, 1e3, "m"),
      within("drift_sigma", drift_sigma, 0.0, 1e3, "m"),
      within("correlation_time", correlation_time, 1e-3, 1e6, "s"),
      within("vertical_factor", vertical_factor, 0.0, 100.0, "(a factor)"),
      within("covariance_factor", covariance_factor, 0.0, 1e6, "(a factor)"),
      within("jumps_per_hour", jumps_per_hour, 0.0, 3600.0, "an hour"),
      within("jump_size", jump_size, 0.0, 1e4, "m"),
      within("jump_duration", jump_duration, 0.0, 1e5, "s"),
      within("altitude_wave", altitude_wave, 0.0, 1e4, "m"),
      within("altitude_period", altitude_period, 1.0, 1e6, "s"),
  });
}

}  // namespace fleetmap::sim
