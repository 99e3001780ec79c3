#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::testing {

/// Conditions of a drive and of its LiDAR.
struct DriveCondition {
  const char* name;
  double speed = 1.0;           ///< m/s
  double lane_share = 0.88;     ///< of each lane's length is driven
  double turn_rate = 0.8;       ///< rad/s, on the spot at the ends of lanes
  double tilt = 0.0;            ///< rad, amplitude of bumps some metres long
  double shake = 0.0;           ///< Hz, of the mast
  double shake_way = 0.0;       ///< m, amplitude
  double shake_angle = 0.0;     ///< rad, amplitude
  double noise = 0.02;          ///< m, of a range
  double rate = 10.0;           ///< Hz, of the LiDAR
  int every = 1;                ///< of its scans are used
  double keep = 1.0;            ///< share of its rays
  const char* lidar = "vlp16";  ///< of config/sensors
};

/// A drive up and down the lanes of a world that turns on the spot at their ends, as base_link's pose at
/// every kStep. Deterministic.
class LaneDrive {
 public:
  static constexpr double kStep = 0.001;  ///< s; a mast that shakes at 30 Hz is followed

  /// `length` m at least, until the end of a lane; the seed chooses the first lane and the phases of bumps
  /// and mast.
  LaneDrive(const sim::World& world, const DriveCondition& how, double length, std::uint64_t seed);

  double duration() const { return kStep * static_cast<double>(planar_.size() - 1); }
  Pose base(std::size_t step) const;
  /// Motion of the LiDAR by the mast, in base_link.
  Pose shaken(std::size_t step) const;

 private:
  struct Planar {
    Eigen::Vector2d at;
    double yaw, way;
  };
  void follow(const std::vector<Eigen::Vector2d>& path);
  Pose on_ground(const Planar& p) const;

  const sim::World& world_;
  DriveCondition how_;
  std::mt19937_64 random_;
  std::array<double, 10> phases_{};
  std::vector<Planar> planar_;
};

}  // namespace fleetmap::testing
