#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/agent/odometry_messages.hpp"
#include "fleetmap/agent/perception_config.hpp"
#include "fleetmap/agent/sensor_mounts.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/bounded_queue.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/localization/ekf.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"
#include "fleetmap/sensor/lidar_frames.hpp"
#include "fleetmap/sensor/sensor_health.hpp"
#include "fleetmap/sensor/turn_direction.hpp"

namespace fleetmap::agent {

/// Result of one scan: O with the points, and G at the same instant if the EKF has one.
struct ScanEstimate {
  odometry::OdometryUpdate odometry;
  std::optional<GlobalPose> G;
  /// Against gravity, in base_link. From the IMU, also where there is no GPS; without an IMU the odometry's
  /// z, which is up if the robot started level.
  Eigen::Vector3d up_in_base = Eigen::Vector3d::UnitZ();
  bool up_is_measured = false;  ///< by the IMU
  double cpu_seconds = 0.0;     ///< that LOAM took
  Stamp arrival;                ///< when the scan came, on the bus's clock
};

struct PerceptionCounters {
  std::uint64_t scans = 0;
  std::uint64_t imu = 0;
  std::uint64_t fixes = 0;
  std::uint64_t wheel = 0;
  std::uint64_t refused_messages = 0;   ///< that could not be decoded
  std::uint64_t refused_scans = 0;      ///< that LOAM could not use
  std::uint64_t dropped_scans = 0;      ///< LOAM was too slow
  std::uint64_t waited_for_frames = 0;  ///< samples left out at the start, before /tf_static stated the mount
  std::uint64_t unclear_stamps = 0;  ///< samples left out at the start, while two sensors' clocks disagreed
};

/// Items 1 and 2 of the paper: sensors in, O (LOAM) and G (EKF) out, also onto the onboard link. LOAM runs
/// off the callback thread, one scan at a time.
class Perception {
 public:
  using OnEstimate = std::function<void(ScanEstimate&&)>;
  /// `on_scan` is called when a scan comes, before and whatever LOAM makes of it.
  Perception(const PerceptionConfig& config, bus::Bus& bus, OnEstimate on_estimate,
             std::function<void()> on_scan = {});

  /// No scan waits or is under way.
  bool idle() const { return !busy_ && scans_.empty(); }
  /// Hears no more sensors and forgets the scans that wait.
  void stop();
  /// When the last sample of a sensor arrived, on the bus's clock.
  Stamp last_sample() const { return last_sample_; }
  /// When a scan was, or else when this was made.
  Stamp last_scan() const { return last_scan_; }
  /// When the last sample came that the checks let through, of GPS with a valid fix; none before. Not of the
  /// LiDAR.
  std::optional<Stamp> last_sound(sensor::Source source) const {
    return last_sound_[static_cast<std::size_t>(source)];
  }
  std::optional<GlobalPose> global_pose() const { return ekf_.pose(); }
  const PerceptionCounters& counters() const { return counters_; }
  const odometry::LoamCounters& odometry_counters() const { return loam_counters_; }
  localization::EkfCounters localization_counters() const { return ekf_.counters(); }
  const sensor::ClockOffsets& clock_offsets() const { return clock_offsets_; }
  const sensor::SensorHealth& health() const { return health_; }
  /// Mounts to be published in /tf_static, as SensorMounts has them.
  std::vector<sensor::FrameTransform> take_unpublished_mounts() {
    return mounts_.take_unpublished(bus_.now());
  }
  /// By the configuration or by /tf_static; final with the first scan that is used.
  const Pose& T_base_lidar() const { return config_.odometry.T_base_lidar; }

 private:
  /// A scan and the other samples that came since the scan before it.
  struct Job {
    Bytes scan;
    Stamp arrival;
    Duration clock_correction{};  ///< of the scan's stamp
    std::vector<sensor::Imu> imu;
    std::vector<sensor::Wheel> wheel;
    std::optional<Eigen::Quaterniond> q_base_imu;  ///< if it was decided since the scan before
    Result<odometry::OdometryUpdate> update = failure("not run");
    ros_codec::TimeUnit point_times = ros_codec::TimeUnit::kAsDefined;
    std::optional<std::pair<Stamp, Duration>> sweep;  ///< stamp and sweep of a decoded scan
    std::optional<Eigen::Vector3d> ground;            ///< its normal in base_link
    std::optional<std::string> turns_finding;         ///< when the direction of turns is decided
    double cpu_seconds = 0.0;
    bool find_ground = false;
  };
  void subscribe();
  /// Hands decoded samples of `topic` to `use`; what cannot be decoded is counted and named.
  template <class T, class Use>
  void on_sample(const bus::Topic& topic, sensor::Source source, std::uint64_t& count, Use use);
  /// Compares `stamp` with those of the other sensors.
  void watch_clock(sensor::Source source, Stamp stamp);
  /// False while the sensor's mount is not known.
  bool placed(sensor::Source source, const Bytes& cdr);
  void on_transforms(const Bytes& cdr);
  /// Makes what is wrong with the mounts findings.
  void report_mounts();
  /// Logs the findings that are new.
  void log_findings();
  void on_scan(const Bytes& cdr);
  void start_next();
  /// Runs LOAM and the checks on a scan, off the callback thread.
  void work_on(Job& job);
  void check_turns(Job& job, const sensor::Scan& scan);
  void finish(Job& job);
  /// Logs when the odometry loses its way and when it has it again.
  void report_loss(const odometry::OdometryUpdate& update);
  /// `kind` is what repeats; `detail` is of this time.
  void warn(const std::string& kind, const std::string& detail);

  PerceptionConfig config_;
  bus::Bus& bus_;
  OnEstimate on_estimate_;
  std::function<void()> on_scan_;
  odometry::Loam loam_;          ///< touched by the work item under way only
  sensor::TurnDirection turns_;  ///< like loam_
  odometry::LoamCounters loam_counters_;
  OdometryMessages odometry_messages_;
  localization::Ekf ekf_;
  sensor::ClockOffsets clock_offsets_;
  sensor::SensorHealth health_;
  sensor::LidarFrames lidar_frames_;
  SensorMounts mounts_;
  std::optional<Eigen::Quaterniond> new_q_base_imu_;
  BoundedQueue<std::pair<Stamp, Bytes>> scans_;  ///< when they came, and as they came
  std::vector<sensor::Imu> imu_since_scan_;
  std::vector<sensor::Wheel> wheel_since_scan_;
  bool busy_ = false;
  Stamp last_sample_, last_scan_;
  std::array<std::optional<Stamp>, sensor::kSources> last_sound_;
  std::uint64_t lost_in_a_row_ = 0;  ///< scans
  std::size_t clock_findings_ = 0;
  PerceptionCounters counters_;
  std::map<std::string, std::uint64_t> warned_;
  std::vector<bus::Handle> subscriptions_;
};

}  // namespace fleetmap::agent
