#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/height_agreement.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::sensor {

/// Compares the track of GPS with that of the odometry, over windows of the drive: jumps, a track that is
/// mirrored (latitude and longitude swapped) or of another size, or that is of another robot or time; and its
/// heights (HeightAgreement).
class GpsAgreement {
 public:
  /// As received.
  void add(const Fix& fix);
  void add_motion(Stamp stamp, const Pose& T_odom_base);
  /// The motion has no relation to the one before.
  void interrupt();
  /// m, by which the height of the next fix is too large.
  double height_correction() const { return heights_.correction(); }
  /// Since the last call.
  std::vector<std::string> take_findings();

 private:
  /// A fix and the odometry at its stamp.
  struct MatchedFix {
    Eigen::Vector2d gps, odom;  ///< m
    double sigma;               ///< m, reported by GPS
  };
  void match(const Fix& fix, const Eigen::Vector3d& odom);
  void check_jump(const MatchedFix& matched);
  void check_track();

  std::optional<LocalFrame> frame_;
  struct Instant {
    Stamp stamp;
    Eigen::Vector3d odom;
  };
  std::optional<Instant> last_;
  std::deque<Fix> waiting_;
  HeightAgreement heights_;
  std::optional<MatchedFix> last_matched_;
  std::deque<MatchedFix> track_;  ///< one every 2 m
  double driven_ = 0.0;           ///< m, since the track was checked
  int contradictions_ = 0;        ///< windows in a row
  bool jump_reported_ = false, track_reported_ = false;
  std::vector<std::string> findings_;
};

}  // namespace fleetmap::sensor
