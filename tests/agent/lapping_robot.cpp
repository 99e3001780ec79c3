#include "agent/lapping_robot.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::testing {
namespace {

using sensor::Source;

constexpr int kTicks = 50;  // a second; of the IMU
constexpr int kTicksOfWheel = 2, kTicksOfGps = kTicks;
/// s from a sample to its arrival; a scan's stamp is that of its first point.
constexpr std::array kLatency{0.105, 0.002, 0.08, 0.01};
constexpr double kGravity = 9.80665;
const GeoPoint kOrigin = geo_point_from_degrees(49.0, 8.4, 110.0);
const Pose kT_base_lidar = make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 0.8));

odometry::LidarModel few_columns(int columns) {
  odometry::LidarModel model = odometry::vlp16();
  model.columns = columns;
  return model;
}

/// A figure eight in the yard at 0.7 to 2.5 m/s: a stamp that is off shows at every turn.
Eigen::Vector3d on_lap(double seconds) {
  const double turn = 2.0 * std::numbers::pi * seconds / LappingRobot::kLap;
  const double at = turn + 0.4 * std::sin(turn);
  return {18.0 + 12.0 * std::sin(at), 4.0 * std::sin(2.0 * at), 0.0};
}

Eigen::Vector3d velocity(double seconds) {
  constexpr double kStep = 1e-3;
  return (on_lap(seconds + kStep) - on_lap(seconds - kStep)) / (2.0 * kStep);
}

Pose T_enu_base(double seconds) {
  const Eigen::Vector3d v = velocity(seconds);
  return make_pose(rotation_from_rpy(0.0, 0.0, std::atan2(v.y(), v.x())), on_lap(seconds));
}

/// rad/s, in base_link.
Eigen::Vector3d turn_rate(double seconds) {
  constexpr double kStep = 1e-3;
  return so3_log(T_enu_base(seconds - kStep).linear().transpose() * T_enu_base(seconds + kStep).linear()) /
         (2.0 * kStep);
}

/// Standard normal, the same for the same sample.
double noise(double seconds, std::uint32_t axis) {
  std::mt19937_64 random(static_cast<std::uint64_t>(std::llround(seconds * 1e3)) * 16 + axis);
  return std::normal_distribution<double>()(random);
}

/// But for the stamp.
const sensor::Scan& scan_of_lap(double seconds, int columns) {
  static std::map<std::pair<int, std::int64_t>, sensor::Scan> scans;
  const double of_lap = std::fmod(seconds, LappingRobot::kLap);
  const auto [scan, is_new] = scans.try_emplace({columns, std::llround(of_lap * kTicks)});
  if (is_new) {
    static const SyntheticWorld world = yard_world();
    ScanOptions options;
    options.max_range = 40.0;
    options.T_base_lidar = kT_base_lidar;
    scan->second = make_scan(world, T_enu_base, of_lap, few_columns(columns), options);
  }
  return scan->second;
}

sensor::Imu imu_at(double seconds) {
  constexpr double kStep = 1e-3;
  sensor::Imu imu;
  const Eigen::Vector3d a = (velocity(seconds + kStep) - velocity(seconds - kStep)) / (2.0 * kStep);
  const Eigen::Matrix3d R = T_enu_base(seconds).linear();
  imu.specific_force = R.transpose() * (a + Eigen::Vector3d(0.0, 0.0, kGravity));
  imu.angular_velocity = turn_rate(seconds);
  for (int axis = 0; axis < 3; ++axis) {
    imu.specific_force[axis] += 0.05 * noise(seconds, static_cast<std::uint32_t>(axis));
    imu.angular_velocity[axis] += 0.003 * noise(seconds, static_cast<std::uint32_t>(axis + 3));
  }
  imu.q_enu_imu = Eigen::Quaterniond(R);
  imu.orientation_variance.setConstant(1e-4);
  return imu;
}

sensor::Fix fix_at(double seconds, double sigma) {
  const Eigen::Vector3d error(sigma * noise(seconds, 6), sigma * noise(seconds, 7),
                              2.0 * sigma * noise(seconds, 8));
  sensor::Fix fix;
  fix.position = LocalFrame(kOrigin).to_geo(on_lap(seconds) + error);
  fix.covariance = sigma * sigma * Eigen::Vector3d(1.0, 1.0, 4.0).asDiagonal();
  return fix;
}

agent::AgentConfig config_of(const LappingRobot::Options& options) {
  agent::AgentConfig config;
  config.id = AgentId::parse("r1").value();
  config.directory = options.folder;
  config.site_origin = kOrigin;
  config.perception.lidar = few_columns(options.columns);
  config.perception.odometry.T_base_lidar = kT_base_lidar;
  for (const Source source : {Source::kLidar, Source::kImu, Source::kGps})
    config.perception.mount_configured[static_cast<std::size_t>(source)] = true;
  config.perception.localization.site_origin = kOrigin;
  config.perception.localization.wheel.turn_offset = 0.0;
  config.exchange.fleet = {config.id};
  config.own_path.min_path = 1e9;  // loops are not of interest here
  config.store.power_safe = false;
  return config;
}

}  // namespace

LappingRobot::LappingRobot(const Options& options) : options_(options) {
  bus::LocalNetworkConfig network;
  network.start = kStart;
  network.perception_time = std::chrono::milliseconds(20);
  network_ = bus::LocalNetwork::create(network).value();
  const auto config = config_of(options);
  bus_ = &network_->add_robot(config.id);
  handles_.push_back(
      bus_->subscribe(ros_codec::topics::odometry(), [this](const Bytes& cdr) { on_odometry(cdr); }));
  handles_.push_back(
      bus_->subscribe(fleet_codec::topics::global_pose(), [this](const Bytes& cdr) { on_position(cdr); }));
  auto agent = agent::Agent::create(config, *bus_);
  if (!agent) throw std::runtime_error(agent.error().message);
  agent_ = std::move(*agent);
}

void LappingRobot::run_for(double seconds) {
  const std::int64_t end = ticks_ + std::llround(seconds * kTicks);
  for (; ticks_ < end; ++ticks_) {
    const double now = static_cast<double>(ticks_) / kTicks;
    network_->run_until(kStart + from_seconds(now));
    sense(now);
  }
}

void LappingRobot::sense(double seconds) {
  namespace topics = ros_codec::topics;
  const auto ticks_of_scan = std::llround(kTicks / options_.scan_rate);
  const auto stamped = [&](Source source, auto sample) {
    sample.stamp = stamp(source, seconds);
    return ros_codec::encode(sample);
  };
  if (ticks_ % ticks_of_scan == 0)
    publish(Source::kLidar, seconds, topics::points(),
            stamped(Source::kLidar, scan_of_lap(seconds, options_.columns)));
  publish(Source::kImu, seconds, topics::imu(), stamped(Source::kImu, imu_at(seconds)));
  if (ticks_ % kTicksOfGps == 0)
    publish(Source::kGps, seconds, topics::fix(), stamped(Source::kGps, fix_at(seconds, options_.gps_sigma)));
  if (ticks_ % kTicksOfWheel == 0) {
    const sensor::Wheel wheel{
        {}, velocity(seconds).norm() + 0.02 * noise(seconds, 9), turn_rate(seconds).z()};
    publish(Source::kWheel, seconds, topics::wheel_odometry(), stamped(Source::kWheel, wheel));
  }
}

void LappingRobot::publish(Source source, double seconds, const bus::Topic& topic, Bytes cdr) {
  const auto k = static_cast<std::size_t>(source);
  if (!options_.fitted[k]) return;
  ++published_[k];
  network_->at(kStart + from_seconds(seconds + kLatency[k]),
               [this, topic, cdr = std::move(cdr)] { bus_->publish(topic, cdr); });
}

Stamp LappingRobot::stamp(Source source, double seconds) const {
  const SensorClock& clock = options_.clocks[static_cast<std::size_t>(source)];
  return kStart + from_seconds(seconds) + clock.ahead + from_seconds(seconds * clock.rate_error);
}

void LappingRobot::on_odometry(const Bytes& cdr) {
  const auto O = ros_codec::decode<ros_codec::OdometryMsg>(cdr).value();
  const Pose T_enu = T_enu_base(to_seconds(O.stamp - kStart));
  if (!T_odom_first_) {
    T_odom_first_ = O.T_odom_base;
    T_enu_first_ = T_enu;
  }
  const Pose since_first = T_odom_first_->inverse() * O.T_odom_base;
  last_odometry_error_ = (since_first.translation() - (T_enu_first_->inverse() * T_enu).translation()).norm();
}

void LappingRobot::on_position(const Bytes& cdr) {
  const auto G = fleet_codec::decode<GlobalPose>(cdr).value();
  const double seconds = to_seconds(G.stamp - kStart);
  const Eigen::Vector3d p = LocalFrame(kOrigin).to_enu(G.position);
  errors_.push_back({seconds, last_odometry_error_, (p - on_lap(seconds)).head<2>().norm()});
}

}  // namespace fleetmap::testing
