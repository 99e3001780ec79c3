#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/running_integral.hpp"

namespace fleetmap::sensor {

/// Lag of the gyro's turns about z behind those of another sensor, by the stamps. The first window of turns
/// is judged by itself; after it a lag must be found in two windows in a row.
class TurnLag {
 public:
  struct Config {
    bool same_scale = true;        ///< else the other sensor's turns are scaled to fit (skid steering)
    bool first_is_usual = false;   ///< the lag of the first window is taken for the usual one
    std::size_t first_steps = 25;  ///< in which a lag would show
    std::size_t later_steps = 12;
    double min_lag = 0.05, min_later_lag = 0.1;  ///< s from the usual lag
  };
  struct Found {
    double lag = 0.0;  ///< s, positive if the gyro is later
    bool at_first = true;
    Stamp since;
  };
  explicit TurnLag(Config config) : config_(config) {}
  /// The other sensor turned by `turned` rad. True where the gyro covers the step and all lags.
  bool add(const RunningIntegral& gyro, Stamp from, Stamp to, double turned);
  /// Once.
  std::optional<Found> take_found();
  bool first_checked() const { return first_checked_; }
  /// The longest lag that is tried.
  static Duration reach();

 private:
  static constexpr int kLags = 20;  ///< on either side
  using ByLag = std::array<double, 2 * kLags + 1>;
  double misfit(std::size_t k) const;
  void check();

  Config config_;
  ByLag gyro_squares_{}, products_{};  ///< rad^2
  double turn_squares_ = 0.0;          ///< rad^2
  std::size_t steps_ = 0;
  std::optional<Stamp> window_from_;
  bool first_checked_ = false, found_any_ = false;
  double usual_ = 0.0;              ///< s
  std::optional<Found> suspected_;  ///< in the last window
  std::optional<Found> found_;
};

}  // namespace fleetmap::sensor
