#include <algorithm>

#include "genz_icp/pipeline/GenZICP.hpp"
#include "peer.hpp"

namespace fleetmap::peers {
namespace {

class GenzIcp final : public Peer {
 public:
  GenzIcp(const Mounts& mounts, const genz_icp::pipeline::GenZConfig& config)
      : T_lidar_base_(mounts.T_base_lidar.inverse()), icp_(config) {}

  Eigen::Isometry3d add(const PeerScan& scan) override {
    std::vector<Eigen::Vector3d> points;
    points.reserve(scan.points.size());
    for (const Eigen::Vector3f& p : scan.points) points.push_back(p.cast<double>());
    icp_.RegisterFrame(points, normalised(scan.times));
    return Eigen::Isometry3d(icp_.poses().back().matrix()) * T_lidar_base_;
  }

 private:
  /// It expects times of 0 to 1.
  static std::vector<double> normalised(const std::vector<float>& times) {
    if (times.empty()) return {};
    const double last = std::max(1e-9f, *std::max_element(times.begin(), times.end()));
    std::vector<double> normal(times.begin(), times.end());
    for (double& t : normal) t /= last;
    return normal;
  }

  Eigen::Isometry3d T_lidar_base_;
  genz_icp::pipeline::GenZICP icp_;
};

}  // namespace

std::unique_ptr<Peer> make_peer(const Mounts& mounts, Settings& settings) {
  genz_icp::pipeline::GenZConfig config;
  settings.read("deskew", config.deskew);
  settings.read("max_range", config.max_range);
  settings.read("min_range", config.min_range);
  settings.read("voxel_size", config.voxel_size);
  settings.read("desired_num_voxelized_points", config.desired_num_voxelized_points);
  settings.read("planarity_threshold", config.planarity_threshold);
  settings.read("max_points_per_voxel", config.max_points_per_voxel);
  settings.read("initial_threshold", config.initial_threshold);
  settings.read("min_motion_th", config.min_motion_th);
  settings.read("max_num_iterations", config.max_num_iterations);
  settings.read("convergence_criterion", config.convergence_criterion);
  return std::make_unique<GenzIcp>(mounts, config);
}

}  // namespace fleetmap::peers
