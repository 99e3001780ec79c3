#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/odometry/lidar_model.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::testing {

/// Ground height in m at x, y, nowhere steeper than `max_slope`.
struct GroundShape {
  std::function<double(double, double)> height;
  double max_slope = 0.0;
};

/// Ground with boxes and upright posts on it, for rays. Exact, deterministic, no files needed.
class SyntheticWorld {
 public:
  /// Level at z = 0 if this is not called.
  void set_ground(GroundShape ground) { ground_ = std::move(ground); }
  const GroundShape& ground() const { return ground_; }
  void add_box(const Pose& T_world_box, const Eigen::Vector3d& half_extent);
  void add_post(const Eigen::Vector2d& position, double radius, double height);
  /// Distance along the unit `direction` to the first surface nearer than `max_range`, or empty.
  std::optional<double> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range) const;

 private:
  struct Box {
    Pose T_box_world;
    Eigen::Vector3d half_extent;
  };
  struct Post {
    Eigen::Vector2d position;
    double radius, height;
  };
  struct Tile {
    std::vector<std::uint32_t> boxes, posts;
  };
  double cast_ground(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range) const;
  static std::int64_t tile_key(std::int64_t x, std::int64_t y) { return x * 1'000'003 + y; }
  void register_area(const Eigen::Vector2d& low, const Eigen::Vector2d& high, bool box, std::uint32_t index);

  GroundShape ground_;
  std::vector<Box> boxes_;
  std::vector<Post> posts_;
  std::unordered_map<std::int64_t, Tile> tiles_;
};

/// Houses, crates, tilted boards and posts around a yard of about 60 m by 60 m; free for driving near the x
/// axis
/// (-5 m to 45 m) and 8 m to either side of it.
SyntheticWorld yard_world();
/// Rows of tilted panels on posts along x, every 6 m in y (y = 0 is the middle of an aisle), 100 m long.
SyntheticWorld panel_world();

/// Two smooth parallel walls, 200 m long, 4 m to either side of the x axis: nothing tells how far one has
/// come.
SyntheticWorld corridor_world();

/// Motion of base_link as a function of seconds.
using PoseAt = std::function<Pose(double)>;

struct ScanOptions {
  double noise = 0.02;  ///< m, 1 sigma, of each range
  std::uint64_t seed = 1;
  double max_range = 100.0;  ///< m
  double keep = 1.0;         ///< share of the returns that is kept, at random
  bool has_time = true;
  bool has_ring = true;
  Pose T_base_lidar = make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 0.8));
};

/// One revolution that starts at `seconds` (the scan's stamp), each ray cast from where the sensor is at that
/// moment. A model with rings fires column by column, clockwise from the rear; one without draws a
/// non-repeating rosette.
sensor::Scan make_scan(const SyntheticWorld& world, const PoseAt& pose_at, double seconds,
                       const odometry::LidarModel& model, const ScanOptions& options = {});

struct DriveLeg {
  double duration;  ///< s
  double speed;     ///< m/s, reached with limited acceleration
  double yaw_rate;  ///< rad/s, reached with limited acceleration
};

/// A ground robot's drive on level ground from the origin along x, with the slight pitch and roll of a real
/// chassis.
class SyntheticDrive {
 public:
  explicit SyntheticDrive(const std::vector<DriveLeg>& legs, double acceleration = 1.0,
                          double yaw_acceleration = 2.0, double sway = 0.01);
  Pose at(double seconds) const;  ///< T_world_base; clamped to [0, duration]
  double duration() const { return step_ * static_cast<double>(states_.size() - 1); }
  double speed(double seconds) const;
  /// Exact rates and no accelerations; noise and bias are up to the test.
  sensor::Imu imu(double seconds) const;
  sensor::Wheel wheel(double seconds) const;

 private:
  struct State {
    double x = 0, y = 0, yaw = 0, speed = 0, yaw_rate = 0;
  };
  State state(double seconds) const;

  double step_ = 1e-3;
  double sway_;
  std::vector<State> states_;
};

}  // namespace fleetmap::testing
