#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/stream_silence.hpp"

namespace fleetmap::sensor {

/// The gaps of GPS and wheels on a drive, which goes on by the stamps of another sensor.
class DriveSilences {
 public:
  void add_fix(Stamp stamp) { fixes_.add(stamp); }
  /// A fix of a receiver without a position.
  void add_empty_fix() { fixes_.add_empty(); }
  void add_wheel(Stamp stamp) { wheels_.add(stamp); }
  /// The drive has reached `stamp`, at `position` (m) of the odometry if there is any.
  void pass(Stamp stamp, const std::optional<Eigen::Vector3d>& position);
  /// The same while the odometry is lost, as it is in a robot that drives.
  void pass_lost(Stamp stamp);
  /// Since the last call.
  std::vector<std::string> take_findings();
  /// A sentence on the gaps of each until now, which are no finding unless they are long.
  std::vector<std::string> notes() const;

 private:
  void pass(Stamp stamp, double moved);

  StreamSilence fixes_{fix_silence()}, wheels_{wheel_silence()};
  std::optional<Stamp> passed_to_;
  std::optional<Eigen::Vector3d> moved_from_;
  std::vector<std::string> findings_;
};

}  // namespace fleetmap::sensor
