#include "fleetmap/ros_codec/samples.hpp"

#include <cmath>
#include <limits>

#include "fleetmap/bus/cdr.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "nav_msgs.h"
#include "ros_geometry.hpp"
#include "ros_time.hpp"
#include "sensor_msgs.h"
#include "type_names.hpp"

namespace fleetmap::ros_codec {
namespace {

namespace geometry = geometry_msgs::msg::dds_;
namespace sensors = sensor_msgs::msg::dds_;
using nav_msgs::msg::dds_::Odometry_;

constexpr std::size_t kYawRateVariance = 35;
constexpr std::int8_t kNoFix = -1;
/// Bits of NavSatStatus.service. The definition has no field for heights above sea level, which a recording
/// has to keep, and uses the lowest four.
enum Service : std::uint16_t { kGps = 1, kAboveSeaLevel = 0x8000 };
enum CovarianceType : std::uint8_t { kUnknown = 0, kKnown = 3 };

/// Unit, or close enough that rounding explains the rest.
bool is_rotation(const Eigen::Quaterniond& q) { return std::abs(q.norm() - 1.0) <= 1e-2; }

std::optional<Pose> pose_of(const geometry::Pose_& in) {
  const Eigen::Vector3d t(in.position().x(), in.position().y(), in.position().z());
  const Eigen::Quaterniond q = from_ros(in.orientation());
  if (!t.allFinite() || !is_rotation(q)) return std::nullopt;
  return make_pose(q.normalized(), t);
}

tl::unexpected<Error> refused(const char* type, const char* what) {
  return failure(std::string(type) + ": " + what);
}

}  // namespace

Bytes encode(const sensor::Imu& imu, std::string_view frame_id) {
  sensors::Imu_ out;
  out.header().stamp(to_ros(imu.stamp));
  out.header().frame_id(std::string(frame_id));
  out.orientation(to_ros(imu.q_enu_imu.value_or(Eigen::Quaterniond::Identity())));
  std::array<double, 9> covariance{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    covariance[4 * axis] = imu.orientation_variance[static_cast<int>(axis)];
  if (!imu.q_enu_imu) covariance = {-1.0};
  out.orientation_covariance(covariance);
  out.angular_velocity(to_ros(imu.angular_velocity));
  out.linear_acceleration(to_ros(imu.specific_force));
  return bus::to_cdr(out);
}

template <>
Result<sensor::Imu> decode(ByteView cdr) {
  const auto in = bus::from_cdr<sensors::Imu_>(cdr, type_name::kImu);
  if (!in) return tl::unexpected(in.error());
  const auto stamp = from_ros(in->header().stamp(), type_name::kImu);
  if (!stamp) return tl::unexpected(stamp.error());
  sensor::Imu imu;
  imu.stamp = *stamp;
  imu.angular_velocity = from_ros(in->angular_velocity());
  imu.specific_force = from_ros(in->linear_acceleration());
  if (!imu.angular_velocity.allFinite()) return refused(type_name::kImu, "angular_velocity is not finite");
  if (!imu.specific_force.allFinite()) return refused(type_name::kImu, "linear_acceleration is not finite");
  const Eigen::Quaterniond q = from_ros(in->orientation());
  const auto& covariance = in->orientation_covariance();
  if (covariance[0] != -1.0 && is_rotation(q)) {
    imu.q_enu_imu = q.normalized();
    const Eigen::Vector3d variance(covariance[0], covariance[4], covariance[8]);
    if (variance.allFinite()) imu.orientation_variance = variance.cwiseMax(0.0);
  }
  return imu;
}

Bytes encode(const sensor::Fix& fix, std::string_view frame_id) {
  sensors::NavSatFix_ out;
  out.header().stamp(to_ros(fix.stamp));
  out.header().frame_id(std::string(frame_id));
  out.status().status(fix.valid ? 0 : kNoFix);
  out.status().service(static_cast<std::uint16_t>(fix.above_sea_level ? kGps | kAboveSeaLevel : kGps));
  out.latitude(fix.position.latitude / kDegree);
  out.longitude(fix.position.longitude / kDegree);
  out.altitude(fix.position.altitude);
  std::array<double, 9> covariance{};
  for (std::size_t k = 0; k < 9; ++k) {
    covariance[k] = fix.covariance(static_cast<int>(k) / 3, static_cast<int>(k) % 3);
  }
  out.position_covariance(covariance);
  out.position_covariance_type(fix.covariance.isZero(0.0) ? kUnknown : kKnown);
  return bus::to_cdr(out);
}

template <>
Result<sensor::Fix> decode(ByteView cdr) {
  const auto in = bus::from_cdr<sensors::NavSatFix_>(cdr, type_name::kNavSatFix);
  if (!in) return tl::unexpected(in.error());
  const auto stamp = from_ros(in->header().stamp(), type_name::kNavSatFix);
  if (!stamp) return tl::unexpected(stamp.error());
  sensor::Fix fix;
  fix.stamp = *stamp;
  fix.position = geo_point_from_degrees(in->latitude(), in->longitude(), in->altitude());
  fix.valid = in->status().status() > kNoFix && is_valid(fix.position);
  fix.above_sea_level = in->status().service() == (kGps | kAboveSeaLevel);
  if (in->position_covariance_type() != kUnknown) {
    for (std::size_t k = 0; k < 9; ++k) {
      fix.covariance(static_cast<int>(k) / 3, static_cast<int>(k) % 3) = in->position_covariance()[k];
    }
  }
  return fix;
}

Bytes encode(const sensor::Wheel& wheel) {
  Odometry_ out;
  out.header().stamp(to_ros(wheel.stamp));
  out.header().frame_id("odom");
  out.child_frame_id("base_link");
  out.pose().pose(to_ros(wheel.T_odom_base.value_or(Pose::Identity())));
  out.twist().twist().linear().x(wheel.forward_speed);
  out.twist().twist().angular().z(wheel.yaw_rate.value_or(0.0));
  if (!wheel.yaw_rate) out.twist().covariance()[kYawRateVariance] = -1.0;
  return bus::to_cdr(out);
}

template <>
Result<sensor::Wheel> decode(ByteView cdr) {
  const auto in = bus::from_cdr<Odometry_>(cdr, type_name::kOdometry);
  if (!in) return tl::unexpected(in.error());
  const auto stamp = from_ros(in->header().stamp(), type_name::kOdometry);
  if (!stamp) return tl::unexpected(stamp.error());
  sensor::Wheel wheel;
  wheel.stamp = *stamp;
  wheel.forward_speed = in->twist().twist().linear().x();
  if (!std::isfinite(wheel.forward_speed))
    return refused(type_name::kOdometry, "twist.linear.x is not finite");
  const double yaw_rate = in->twist().twist().angular().z();
  if (std::isfinite(yaw_rate) && in->twist().covariance()[kYawRateVariance] >= 0.0) wheel.yaw_rate = yaw_rate;
  wheel.T_odom_base = pose_of(in->pose().pose());
  return wheel;
}

Bytes encode(const OdometryMsg& odometry) {
  Odometry_ out;
  out.header().stamp(to_ros(odometry.stamp));
  out.header().frame_id("odom");
  out.child_frame_id("base_link");
  out.pose().pose(to_ros(odometry.T_odom_base));
  out.pose().covariance(to_ros(odometry.covariance));
  out.twist().twist().linear(to_ros(Eigen::Vector3d(odometry.twist.head<3>())));
  out.twist().twist().angular(to_ros(Eigen::Vector3d(odometry.twist.tail<3>())));
  out.twist().covariance(to_ros(odometry.twist_covariance));
  return bus::to_cdr(out);
}

template <>
Result<OdometryMsg> decode(ByteView cdr) {
  const auto in = bus::from_cdr<Odometry_>(cdr, type_name::kOdometry);
  if (!in) return tl::unexpected(in.error());
  const auto stamp = from_ros(in->header().stamp(), type_name::kOdometry);
  if (!stamp) return tl::unexpected(stamp.error());
  const auto& position = in->pose().pose().position();
  const Eigen::Quaterniond q = from_ros(in->pose().pose().orientation());
  const Eigen::Vector3d t(position.x(), position.y(), position.z());
  if (!t.allFinite()) return refused(type_name::kOdometry, "pose.position is not finite");
  if (!is_rotation(q)) return refused(type_name::kOdometry, "pose.orientation is not a unit quaternion");
  OdometryMsg odometry;
  odometry.stamp = *stamp;
  odometry.T_odom_base = make_pose(q, t);
  odometry.covariance = covariance_from_ros(in->pose().covariance());
  odometry.twist << from_ros(in->twist().twist().linear()), from_ros(in->twist().twist().angular());
  odometry.twist_covariance = covariance_from_ros(in->twist().covariance());
  if (!odometry.covariance.allFinite()) return refused(type_name::kOdometry, "pose.covariance is not finite");
  if (!odometry.twist.allFinite()) return refused(type_name::kOdometry, "twist is not finite");
  if (!odometry.twist_covariance.allFinite())
    return refused(type_name::kOdometry, "twist.covariance is not finite");
  return odometry;
}

Bytes encode(const VelocityCommand& command) {
  geometry::Twist_ out;
  out.linear().x(command.forward_speed);
  out.angular().z(command.yaw_rate);
  return bus::to_cdr(out);
}

template <>
Result<VelocityCommand> decode(ByteView cdr) {
  const auto in = bus::from_cdr<geometry::Twist_>(cdr, type_name::kTwist);
  if (!in) return tl::unexpected(in.error());
  const VelocityCommand command{in->linear().x(), in->angular().z()};
  if (!std::isfinite(command.forward_speed) || !std::isfinite(command.yaw_rate)) {
    return refused(type_name::kTwist, "linear.x or angular.z is not finite");
  }
  return command;
}

Bytes encode(const sensor::Battery& battery) {
  constexpr float kUnknownValue = std::numeric_limits<float>::quiet_NaN();
  sensors::BatteryState_ out;
  out.header().stamp(to_ros(battery.stamp));
  for (auto* value : {&out.voltage(), &out.temperature(), &out.current(), &out.charge(), &out.capacity(),
                      &out.design_capacity()})
    *value = kUnknownValue;
  out.percentage(static_cast<float>(battery.share));
  out.present(true);
  return bus::to_cdr(out);
}

template <>
Result<sensor::Battery> decode(ByteView cdr) {
  const auto in = bus::from_cdr<sensors::BatteryState_>(cdr, type_name::kBatteryState);
  if (!in) return tl::unexpected(in.error());
  const auto stamp = from_ros(in->header().stamp(), type_name::kBatteryState);
  if (!stamp) return tl::unexpected(stamp.error());
  const double share = static_cast<double>(in->percentage());
  if (!(share >= 0.0 && share <= 1.0))
    return refused(type_name::kBatteryState, "percentage is not in [0, 1]");
  return sensor::Battery{*stamp, share};
}

}  // namespace fleetmap::ros_codec
