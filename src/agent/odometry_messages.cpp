#include "fleetmap/agent/odometry_messages.hpp"

#include "fleetmap/geometry/rotated_covariance.hpp"

namespace fleetmap::agent {
namespace {

/// Variance of a twist that nothing was measured of, (m/s)^2 and (rad/s)^2.
constexpr double kUnknownTwist = 1e3;

}  // namespace

ros_codec::OdometryMsg OdometryMessages::next(const odometry::OdometryUpdate& update,
                                              const odometry::LoamCounters& counters) {
  if (const std::uint64_t frame = counters.map_restarts + counters.clock_resets; frame != frame_) {
    // The pose goes on from a guess, and so does its uncertainty.
    step_ = {};
    last_.reset();
    frame_ = frame;
  }
  way_.add(update);
  step_.add(update);
  ros_codec::OdometryMsg message{update.stamp, update.T_odom_base, Matrix6d::Zero(), update.twist,
                                 kUnknownTwist * Matrix6d::Identity()};
  message.covariance = rotated(way_.since_reference(), update.T_odom_base.linear());
  if (last_ && update.stamp > *last_) {
    const double elapsed = to_seconds(update.stamp - *last_);
    message.twist_covariance = step_.since_reference() / (elapsed * elapsed);
  }
  step_.restart();
  last_ = update.stamp;
  return message;
}

}  // namespace fleetmap::agent
