#include "fleetmap/fleet_codec/global_pose.hpp"

#include "fields.hpp"
#include "fleetmap/fleet_codec/bounds.hpp"
#include "fleetmap_onboard.h"
#include "schema.hpp"
#include "type_names.hpp"

namespace fleetmap::fleet_codec {

Bytes encode(const GlobalPose& pose) {
  const Eigen::Quaterniond& q = pose.q_enu_base;
  msg::GlobalPose out;
  out.schema(kSchemaVersion);
  out.stamp(to_ns(pose.stamp));
  out.latitude(pose.position.latitude);
  out.longitude(pose.position.longitude);
  out.altitude(pose.position.altitude);
  out.orientation({q.x(), q.y(), q.z(), q.w()});
  out.covariance(upper_triangle<double>(pose.covariance));
  return bus::to_cdr(out);
}

template <>
Result<GlobalPose> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::GlobalPose>(cdr, type_name::kGlobalPose);
  if (!in) return tl::unexpected(in.error());
  FieldCheck check(type_name::kGlobalPose);
  GlobalPose pose;
  pose.stamp = check.stamp(in->stamp());
  pose.position = check.position(in->latitude(), in->longitude(), in->altitude());
  const auto& q = in->orientation();
  pose.q_enu_base = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  check.within(pose.q_enu_base.norm() - 1.0, 1e-6, "norm of orientation");
  pose.covariance = covariance_from(in->covariance(), check);
  return check.finish(pose);
}

}  // namespace fleetmap::fleet_codec
