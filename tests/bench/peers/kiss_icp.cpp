#include "kiss_icp/pipeline/KissICP.hpp"
#include "peer.hpp"

namespace fleetmap::peers {
namespace {

class KissIcp final : public Peer {
 public:
  KissIcp(const Mounts& mounts, const kiss_icp::pipeline::KISSConfig& config)
      : T_lidar_base_(mounts.T_base_lidar.inverse()), icp_(config) {}

  Eigen::Isometry3d add(const PeerScan& scan) override {
    std::vector<Eigen::Vector3d> points;
    points.reserve(scan.points.size());
    for (const Eigen::Vector3f& p : scan.points) points.push_back(p.cast<double>());
    icp_.RegisterFrame(points, std::vector<double>(scan.times.begin(), scan.times.end()));
    return Eigen::Isometry3d(icp_.pose().matrix()) * T_lidar_base_;
  }

 private:
  Eigen::Isometry3d T_lidar_base_;
  kiss_icp::pipeline::KissICP icp_;
};

}  // namespace

std::unique_ptr<Peer> make_peer(const Mounts& mounts, Settings& settings) {
  kiss_icp::pipeline::KISSConfig config;
  config.max_num_threads = 1;
  settings.read("voxel_size", config.voxel_size);
  settings.read("min_range", config.min_range);
  settings.read("deskew", config.deskew);
  return std::make_unique<KissIcp>(mounts, config);
}

}  // namespace fleetmap::peers
