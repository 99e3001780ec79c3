#include <exception>

#include "peer.hpp"
#include "rko_lio/core/lio.hpp"

namespace fleetmap::peers {
namespace {

using rko_lio::core::LIO;
using rko_lio::core::Nsec;
using rko_lio::core::Scalar;

/// Recordings may begin at 0 s, where it takes times since the start of a sweep for absolute ones.
constexpr Nsec kEpoch = std::chrono::seconds(1000);

Sophus::SE3s to_sophus(const Eigen::Isometry3d& T) {
  return {Eigen::Quaternion<Scalar>(Eigen::Quaterniond(T.linear()).cast<Scalar>()),
          Eigen::Matrix<Scalar, 3, 1>(T.translation().cast<Scalar>())};
}

class RkoLio final : public Peer {
 public:
  RkoLio(const Mounts& mounts, const LIO::Config& config, bool imu)
      : T_base_lidar_(to_sophus(mounts.T_base_lidar)),
        T_base_imu_(to_sophus(mounts.T_base_imu)),
        imu_(imu),
        lio_(config) {}

  bool wants_imu() const override { return imu_; }
  void add(const PeerImu& imu) override {
    lio_.add_imu_measurement(T_base_imu_, {.time = kEpoch + Nsec(imu.stamp),
                                           .acceleration = imu.specific_force.cast<Scalar>(),
                                           .angular_velocity = imu.angular_velocity.cast<Scalar>()});
  }
  Eigen::Isometry3d add(const PeerScan& scan) override {
    const std::vector<double> times(scan.times.begin(), scan.times.end());
    const auto stamps =
        rko_lio::core::process_timestamps(times, kEpoch + Nsec(scan.start), {.force_relative = true});
    rko_lio::core::Vector3sVector points(scan.points.begin(), scan.points.end());
    try {
      lio_.register_scan(T_base_lidar_, std::move(points), stamps);
    } catch (const std::exception&) {  // without correspondences it keeps its pose
    }
    return Eigen::Isometry3d(lio_.lidar_state.pose.cast<double>().matrix());
  }

 private:
  Sophus::SE3s T_base_lidar_, T_base_imu_;
  bool imu_;
  LIO lio_;
};

}  // namespace

std::unique_ptr<Peer> make_peer(const Mounts& mounts, Settings& settings) {
  LIO::Config config;
  bool imu = false;
  config.max_num_threads = 1;
  settings.read("imu", imu);
  settings.read("voxel_size", config.voxel_size);
  settings.read("min_range", config.min_range);
  return std::make_unique<RkoLio>(mounts, config, imu);
}

}  // namespace fleetmap::peers
