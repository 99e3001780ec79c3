#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// The input and the output of all peers.
namespace fleetmap::peers {

/// One sweep, points in the LiDAR frame.
struct PeerScan {
  std::int64_t start = 0;  ///< ns
  std::vector<Eigen::Vector3f> points;
  std::vector<float> times;  ///< s after the start
};

struct PeerImu {
  std::int64_t stamp = 0;                            ///< ns
  Eigen::Vector3d angular_velocity, specific_force;  ///< in the IMU frame
};

/// Settings by name; a name that is left over after all were read is an error.
class Settings {
 public:
  explicit Settings(std::map<std::string, double> values) : values_(std::move(values)) {}
  /// Replaces `value` if it is set.
  template <typename T>
  void read(const std::string& name, T& value) {
    const auto found = values_.find(name);
    if (found == values_.end()) return;
    value = static_cast<T>(found->second);
    values_.erase(found);
  }
  const std::map<std::string, double>& left() const { return values_; }

 private:
  std::map<std::string, double> values_;
};

struct Mounts {
  Eigen::Isometry3d T_base_lidar = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_base_imu = Eigen::Isometry3d::Identity();
};

class Peer {
 public:
  virtual ~Peer() = default;
  virtual bool wants_imu() const { return false; }
  virtual void add(const PeerImu&) {}
  /// Pose of base_link in the peer's own frame.
  virtual Eigen::Isometry3d add(const PeerScan& scan) = 0;
};

/// Each peer's own file defines it.
std::unique_ptr<Peer> make_peer(const Mounts& mounts, Settings& settings);

}  // namespace fleetmap::peers
