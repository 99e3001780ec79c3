#pragma once

#include <deque>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/place/descriptor.hpp"

namespace fleetmap::agent {

/// The last submaps of the odometry frame, coarsely: what is around a fresh node, also behind a sensor that
/// looks ahead only. Makes the node's descriptor.
class RecentSurroundings {
 public:
  /// Points of the submap that ends at `p_odom`, in the odometry frame.
  void add(const cloud::PointCloud& submap_in_odom, const Eigen::Vector3d& p_odom);
  /// A new odometry frame has begun.
  void clear() { submaps_.clear(); }
  place::Descriptor describe(const Pose& T_odom_base, const Eigen::Vector3d& up_in_base) const;

 private:
  struct Submap {
    Eigen::Vector3d p_odom;
    cloud::PointCloud points;
  };
  std::deque<Submap> submaps_;  ///< newest last
};

}  // namespace fleetmap::agent
