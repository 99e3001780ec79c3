#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <string>

#include "fleetmap/core/time.hpp"

namespace fleetmap::sensor {

/// Compares the height of fixes with that of the odometry: a step that lasts is that of the receiver (RTK
/// lost, another base station, ellipsoid or sea level) and would tilt the map.
class HeightAgreement {
 public:
  /// A fix as received, and the odometry at its stamp.
  struct Height {
    Stamp stamp;
    double gps;            ///< m
    double sigma;          ///< m, reported
    Eigen::Vector3d odom;  ///< m
  };
  void add(const Height& height);
  /// The motion has no relation to the one before.
  void interrupt();
  /// m: the sum of the steps that were found, by which later heights are too large.
  double correction() const { return correction_; }
  /// About the first step, since the last call.
  std::optional<std::string> take_finding();

 private:
  /// The fixes before have no relation to those that come.
  void begin_anew();
  /// Heights are on another level (m, above the odometry) since after_.front().
  void begin_after(double level_before, double level);

  std::deque<Height> before_;  ///< the last that agree
  std::deque<Height> after_;   ///< in a row that agree with one another and not with those before
  std::optional<Stamp> first_;
  std::optional<double> first_level_;  ///< m, of right heights above the odometry at the beginning
  std::optional<double> last_gps_;     ///< m
  bool anew_ = false;                  ///< no fix since begin_anew()
  double correction_ = 0.0;
  bool reported_ = false;
  std::optional<std::string> finding_;
};

}  // namespace fleetmap::sensor
