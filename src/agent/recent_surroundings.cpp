#include "fleetmap/agent/recent_surroundings.hpp"

#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::agent {
namespace {

constexpr float kVoxel = 0.4f;           // m: the cells of a descriptor are much larger
constexpr double kReach = 30.0;          // m from the node
constexpr std::size_t kMaxSubmaps = 12;  // submaps

}  // namespace

void RecentSurroundings::add(const cloud::PointCloud& submap_in_odom, const Eigen::Vector3d& p_odom) {
  submaps_.push_back({p_odom, cloud::voxel_downsample(submap_in_odom, kVoxel)});
  while (submaps_.size() > kMaxSubmaps || (submaps_.front().p_odom - p_odom).norm() > kReach)
    submaps_.pop_front();
}

place::Descriptor RecentSurroundings::describe(const Pose& T_odom_base,
                                               const Eigen::Vector3d& up_in_base) const {
  std::vector<Eigen::Vector3f> around;
  const Eigen::Isometry3f T_base_odom = T_odom_base.inverse().cast<float>();
  for (const Submap& submap : submaps_) {
    for (const Eigen::Vector3f& p : submap.points.points) around.push_back(T_base_odom * p);
  }
  return place::Descriptor::of(around, up_in_base);
}

}  // namespace fleetmap::agent
