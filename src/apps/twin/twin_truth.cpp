#include "twin_truth.hpp"

#include <algorithm>

namespace fleetmap::apps {
namespace {

// A body that sways at some hertz must not be straightened between two of them.
constexpr Duration kTruthPeriod = std::chrono::milliseconds(20);

}  // namespace

void TruthTrack::follow(const sim::RobotTwin& twin) {
  if (poses_.empty() || twin.now() - poses_.back().stamp >= kTruthPeriod)
    poses_.push_back({twin.now(), twin.T_enu_base()});
}

GlobalPose true_pose(const sim::RobotTwin& twin, const LocalFrame& site) {
  const Pose T_enu_base = twin.T_enu_base();
  GlobalPose pose;
  pose.stamp = twin.now();
  pose.position = site.to_geo(T_enu_base.translation());
  pose.q_enu_base = Eigen::Quaterniond(site.R_enu_local(pose.position).transpose() * T_enu_base.linear());
  pose.covariance.setZero();
  return pose;
}

double battery_share(const sim::RobotTwin& twin) {
  return std::clamp(twin.battery_wh() / twin.config().vehicle.battery_wh, 0.0, 1.0);
}

}  // namespace fleetmap::apps
