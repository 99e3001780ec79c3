#include "generated_fleet.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "synthetic_lidar.hpp"

namespace fleetmap::testing {
namespace {

constexpr std::int64_t kStart = 1'750'000'000'000'000'000;
constexpr Duration kTick = std::chrono::milliseconds(10);
constexpr double kGpsSigma = 1.5;
constexpr double kGpsTime = 60.0;
constexpr double kSameStamp = 1e-3;   // s
constexpr double kKeptReturns = 0.3;  // or the recordings of a test would fill small disks

/// First-order Gauss-Markov error of a position.
class GpsError {
 public:
  explicit GpsError(std::uint64_t seed) : random_(seed) {
    for (int k = 0; k < 3; ++k) error_[k] = kGpsSigma * normal_(random_);
  }
  Eigen::Vector3d next(double dt) {
    const double keep = std::exp(-dt / kGpsTime);
    for (int k = 0; k < 3; ++k)
      error_[k] = keep * error_[k] + kGpsSigma * std::sqrt(1.0 - keep * keep) * normal_(random_);
    return error_;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Eigen::Vector3d error_;
};

struct Robot {
  std::string id;
  Pose T_enu_start;
  SyntheticDrive drive;
  std::uint64_t seed;
  bool gps = true;
};

class RobotRecording {
 public:
  RobotRecording(const Robot& robot, const SyntheticWorld& world, const LocalFrame& site,
                 recording::BagWriter& bag)
      : robot_(robot), world_(world), site_(site), bag_(bag), random_(robot.seed), gps_(robot.seed + 100) {}

  Result<GeneratedRobot> write() {
    truth_.id = robot_.id;
    const auto ticks = static_cast<int>(robot_.drive.duration() / to_seconds(kTick));
    for (int tick = 0; tick < ticks && status_; ++tick) {
      const double t = tick * to_seconds(kTick);
      const Stamp stamp = stamp_from_ns(kStart) + tick * kTick;
      write_imu(t, stamp);
      if (tick % 5 == 0) write_wheel(t, stamp);
      if (robot_.gps && tick % 20 == 0) write_fix(t, stamp);
      // A scan reaches the recorder when its revolution is over.
      if (tick % 10 == 0 && tick >= 10) write_scan(t - 0.1, stamp - std::chrono::milliseconds(100), stamp);
    }
    if (!status_) return tl::unexpected(status_.error());
    return truth_;
  }

 private:
  Pose T_enu_base(double t) const { return robot_.T_enu_start * robot_.drive.at(t); }
  double noise(double sigma) { return sigma * normal_(random_); }
  template <class T>
  void put(const bus::Topic& topic, const T& sample, Stamp received) {
    const Status written = bag_.write(topic.name, topic.type, received, ros_codec::encode(sample));
    if (!written && status_) status_ = written;
  }

  void write_imu(double t, Stamp stamp) {
    sensor::Imu imu = robot_.drive.imu(t);
    imu.stamp = stamp;
    for (int k = 0; k < 3; ++k) {
      imu.angular_velocity[k] += 0.002 + noise(0.005);
      imu.specific_force[k] += noise(0.05);
    }
    imu.q_enu_imu = Eigen::Quaterniond(T_enu_base(t).linear() *
                                       rotation_from_rpy(noise(0.005), noise(0.005), noise(0.02)));
    imu.orientation_variance = Eigen::Vector3d(1e-4, 1e-4, 4e-3);
    put(ros_codec::topics::imu(), imu, stamp);
  }
  void write_wheel(double t, Stamp stamp) {
    sensor::Wheel wheel = robot_.drive.wheel(t);
    wheel.stamp = stamp;
    wheel.forward_speed = wheel.forward_speed * 1.01 + noise(0.02);
    put(ros_codec::topics::wheel_odometry(), wheel, stamp);
  }
  void write_fix(double t, Stamp stamp) {
    sensor::Fix fix;
    fix.stamp = stamp;
    fix.position = site_.to_geo(T_enu_base(t).translation() + gps_.next(0.2));
    fix.covariance = Eigen::Matrix3d::Identity() * kGpsSigma * kGpsSigma;
    put(ros_codec::topics::fix(), fix, stamp);
  }
  void write_scan(double t, Stamp stamp, Stamp received) {
    ScanOptions options;
    options.keep = kKeptReturns;
    options.seed = robot_.seed * 100'000 + static_cast<std::uint64_t>(t * 100.0);
    const PoseAt pose_at = [this](double seconds) { return T_enu_base(seconds); };
    sensor::Scan scan = make_scan(world_, pose_at, t, odometry::vlp16(), options);
    scan.stamp = stamp;
    put(ros_codec::topics::points(), scan, received);
    truth_.stamps.push_back(stamp);
    truth_.T_enu_base.push_back(T_enu_base(t));
  }

  const Robot& robot_;
  const SyntheticWorld& world_;
  const LocalFrame& site_;
  recording::BagWriter& bag_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  GpsError gps_;
  GeneratedRobot truth_;
  Status status_;
};

Result<GeneratedFleet> write_robots(const std::filesystem::path& out, const std::vector<Robot>& robots) {
  const SyntheticWorld world = yard_world();
  GeneratedFleet fleet;
  fleet.origin = geo_point_from_degrees(48.2, 11.6, 500.0);
  const LocalFrame site(fleet.origin);
  for (const Robot& robot : robots) {
    auto bag = recording::BagWriter::create(out / robot.id);
    if (!bag) return tl::unexpected(bag.error());
    auto truth = RobotRecording(robot, world, site, *bag).write();
    if (!truth) return tl::unexpected(truth.error());
    if (const Status closed = bag->close(); !closed) return tl::unexpected(closed.error());
    fleet.robots.push_back(std::move(*truth));
  }
  return fleet;
}

}  // namespace

Result<GeneratedFleet> write_generated_fleet(const std::filesystem::path& out,
                                             const std::set<std::string>& without_gps) {
  std::vector<Robot> robots{
      {"r1", Pose::Identity(),
       SyntheticDrive({{2, 0, 0}, {9, 1.2, 0}, {4, 1.0, 0.3}, {4, 1.0, -0.3}, {9, 1.2, 0}}), 1},
      {"r2", make_pose(rotation_from_rpy(0, 0, 3.0), Eigen::Vector3d(42.0, -2.0, 0.0)),
       SyntheticDrive({{2, 0, 0}, {10, 1.2, 0}, {4, 1.0, -0.25}, {4, 1.0, 0.25}, {9, 1.2, 0}}), 2}};
  for (Robot& robot : robots) robot.gps = !without_gps.contains(robot.id);
  return write_robots(out, robots);
}

Result<GeneratedFleet> write_winding_drive(const std::filesystem::path& out) {
  std::vector<DriveLeg> legs{{2, 0, 0}, {2, 0.7, 0.3}};
  for (int k = 0; k < 9; ++k) legs.push_back({4, 0.7, k % 2 == 0 ? -0.3 : 0.3});
  legs.push_back({2, 0.7, 0.3});
  return write_robots(out, {{"r1", Pose::Identity(), SyntheticDrive(legs), 3}});
}

AlignmentErrors errors_of_alignments(const store::Store& store, const GeneratedFleet& fleet) {
  const auto truth_of = [&](const NodeId& id) -> std::optional<Pose> {
    const graph::Node* node = store.node(id);
    const auto robot = std::ranges::find(fleet.robots, id.agent.str(), &GeneratedRobot::id);
    if (node == nullptr || robot == fleet.robots.end()) return std::nullopt;
    // Stamps that went through a text file are rounded.
    const auto at = std::ranges::find_if(
        robot->stamps, [&](Stamp stamp) { return std::abs(to_seconds(stamp - node->stamp)) < kSameStamp; });
    if (at == robot->stamps.end()) return std::nullopt;
    return robot->T_enu_base[static_cast<std::size_t>(at - robot->stamps.begin())];
  };
  AlignmentErrors worst;
  for (const auto& [id, alignment] : store.alignments()) {
    const auto T_enu_i = truth_of(alignment.i), T_enu_j = truth_of(alignment.j);
    if (!T_enu_i || !T_enu_j || alignment.i.agent == alignment.j.agent || alignment.modes.size() != 1)
      continue;
    const Pose T_i_j = T_enu_i->inverse() * *T_enu_j;
    const Pose& estimate = alignment.modes.front().T_i_j;
    ++worst.count;
    worst.translation = std::max(worst.translation, (estimate.translation() - T_i_j.translation()).norm());
    worst.rotation = std::max(worst.rotation, so3_log(T_i_j.linear().transpose() * estimate.linear()).norm());
  }
  return worst;
}

}  // namespace fleetmap::testing
