#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fleetmap/odometry/lidar_model.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::odometry {

/// Compares scans with the LiDAR model that they are read by: a wrong model gives wrong rings and times,
/// which bend every scan and stay unnoticed. Every tenth scan is compared, so that it costs next to nothing.
class ModelCheck {
 public:
  explicit ModelCheck(LidarModel model);

  void add(const sensor::Scan& scan);
  /// Contradictions found since the last call, each reported once with the key to set. Three scans must
  /// agree.
  std::vector<std::string> take_warnings();

 private:
  struct Finding {
    int scans = 0, of = 0;
    bool add(bool found);  ///< true when it is sure, once
  };

  bool rings_differ(const sensor::Scan& scan) const;
  bool times_run_backwards(const sensor::Scan& scan) const;
  static bool in_millimetres(const sensor::Scan& scan);

  LidarModel model_;
  std::vector<double> angles_;  ///< of the rings, ascending, rad
  double spacing_ = 0.0;        ///< of the rings, mean, rad
  std::uint64_t scans_ = 0;
  Finding rings_, times_, units_;
  std::vector<std::string> news_;
};

}  // namespace fleetmap::odometry
