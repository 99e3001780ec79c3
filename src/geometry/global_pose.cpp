#include "fleetmap/geometry/global_pose.hpp"

namespace fleetmap {

Pose pose_in(const LocalFrame& frame, const GlobalPose& G) {
  return make_pose(Eigen::Matrix3d(frame.R_enu_local(G.position) * G.q_enu_base.toRotationMatrix()),
                   frame.to_enu(G.position));
}

}  // namespace fleetmap
