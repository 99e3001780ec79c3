#pragma once

#include <map>
#include <string>
#include <vector>

#include "fleetmap/agent/perception_config.hpp"
#include "fleetmap/agent/sensor_mounts.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/sensor/lidar_frames.hpp"
#include "live_odometry.hpp"
#include "recordings/sample_check.hpp"
#include "recordings/stream_summary.hpp"

namespace fleetmap::apps {

/// Listens to all sensors of a robot, sums up their streams, checks their samples and compares their motions.
class SensorListener {
 public:
  /// `bus` outlives this.
  SensorListener(const agent::PerceptionConfig& config, bus::Bus& bus);

  const StreamSummary& streams() const { return streams_; }
  /// A sentence on the mount of each sensor.
  std::vector<std::string> mounts() const { return mounts_.summaries(); }
  /// Sentences on what is wrong with the samples that came since the last call, and on all that could not be
  /// decoded.
  std::vector<std::string> findings();
  /// A sentence on each topic of IMU, GPS and wheels on which no message came, unless the configuration
  /// switches its use off.
  std::vector<std::string> silent_topics() const;
  /// Sentences on what was not checked, and why.
  std::vector<std::string> notes() const { return odometry_.notes(); }
  /// No work is under way.
  bool idle() const { return odometry_.idle(); }

 private:
  template <class T>
  void listen(const bus::Topic& topic);
  void add_scan(const Bytes& cdr, const std::string& topic);
  template <class T>
  void add(Result<T> decoded, const Bytes& cdr, const std::string& topic);
  /// False while the sensor's mount is not known.
  bool place(sensor::Source source, const std::string& frame_id);

  agent::PerceptionConfig config_;
  bus::Bus& bus_;
  SampleCheck check_;
  LiveOdometry odometry_;
  agent::SensorMounts mounts_;
  sensor::LidarFrames lidar_frames_;
  StreamSummary streams_;
  std::map<std::string, std::size_t> refused_;  ///< by reason
  std::vector<bus::Handle> subscriptions_;
};

}  // namespace fleetmap::apps
