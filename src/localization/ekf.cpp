#include "fleetmap/localization/ekf.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::localization {
namespace {

constexpr double kMaxTurnRate = 100.0;                         ///< rad/s, beyond any gyro
constexpr double kMaxSpecificForce = 1000.0;                   ///< m/s^2, beyond any accelerometer
constexpr double kMaxSpeed = 200.0;                            ///< m/s
constexpr std::int64_t kMaxStamp = 4'000'000'000'000'000'000;  ///< ns, so that differences cannot overflow
constexpr int kBehindToRestart = 50;

bool is_sane(const sensor::Imu& imu) {
  return imu.angular_velocity.allFinite() && imu.specific_force.allFinite() &&
         imu.angular_velocity.norm() < kMaxTurnRate && imu.specific_force.norm() < kMaxSpecificForce;
}

bool is_sane(const sensor::Wheel& wheel) {
  return std::abs(wheel.forward_speed) < kMaxSpeed &&
         (!wheel.yaw_rate || std::abs(*wheel.yaw_rate) < kMaxTurnRate);
}

/// IMU before wheel before fix at equal stamps: each is predicted by the ones before it.
std::pair<Stamp, std::size_t> order_of(const Sample& sample) { return {stamp_of(sample), sample.index()}; }

}  // namespace

std::optional<GlobalPose> global_pose(const Filter& filter) {
  if (filter.phase == Phase::kWaiting || !filter.frame) return std::nullopt;
  GlobalPose G;
  G.stamp = filter.stamp;
  G.position = filter.frame->to_geo(filter.p);
  const Eigen::Matrix3d R_local_enu = filter.frame->R_enu_local(G.position).transpose();
  G.q_enu_base = Eigen::Quaterniond(Eigen::Matrix3d(R_local_enu * filter.R)).normalized();
  Eigen::Matrix<double, 6, kStates> J = Eigen::Matrix<double, 6, kStates>::Zero();
  J.block<3, 3>(0, kPos) = R_local_enu;
  J.block<3, 3>(3, kAtt) = R_local_enu;
  G.covariance = J * filter.P * J.transpose();
  return G;
}

bool Ekf::add(const sensor::Imu& imu) {
  if (!is_sane(imu)) {
    ++refused_.imu_bad_value;
    return false;
  }
  if (!admit(imu.stamp, 0)) {
    ++refused_.imu_bad_time;
    return false;
  }
  insert(imu);
  return true;
}

bool Ekf::add(const sensor::Wheel& wheel) {
  if (!is_sane(wheel)) {
    ++refused_.wheel_bad_value;
    return false;
  }
  if (!admit(wheel.stamp, 1)) {
    ++refused_.wheel_bad_time;
    return false;
  }
  insert(wheel);
  return true;
}

bool Ekf::add(const sensor::Fix& fix) {
  if (!admit(fix.stamp, 2)) {
    ++refused_.fix_bad_time;
    return false;
  }
  insert(fix);
  return true;
}

bool Ekf::admit(Stamp stamp, std::size_t sensor) {
  if (to_ns(stamp) > kMaxStamp || to_ns(stamp) < -kMaxStamp) return false;
  if (newest().started) {
    const double ahead = to_seconds(stamp - newest().stamp);
    if (ahead < -config_.max_time_jump && ++consecutive_behind_ >= kBehindToRestart) {
      restart();
    } else if (ahead < -config_.max_lateness) {
      return false;
    } else if (ahead > config_.max_time_jump) {
      const bool confirmed =
          unconfirmed_jump_ && std::abs(to_seconds(stamp - *unconfirmed_jump_)) <= config_.max_time_jump;
      unconfirmed_jump_ = stamp;
      if (!confirmed) return false;
    }
  }
  if (last_of_sensor_[sensor] && stamp <= *last_of_sensor_[sensor]) return false;
  last_of_sensor_[sensor] = stamp;
  unconfirmed_jump_.reset();
  consecutive_behind_ = 0;
  return true;
}

void Ekf::restart() {
  EkfCounters counters = newest().counters;
  ++counters.restarts;
  base_ = Filter();
  base_.counters = counters;
  records_.clear();
  last_of_sensor_ = {};
}

void Ekf::insert(Sample sample) {
  const auto key = order_of(sample);
  const auto at =
      std::upper_bound(records_.begin(), records_.end(), key,
                       [](const auto& k, const Record& record) { return k < order_of(record.sample); });
  const Filter& before = at == records_.begin() ? base_ : std::prev(at)->after;
  // Only where history is shorter than it should be, just after the start.
  if (before.started && key.first < before.stamp) return;
  auto record = records_.insert(at, Record{std::move(sample), before});
  for (; record != records_.end(); ++record) {
    record->after = record == records_.begin() ? base_ : std::prev(record)->after;
    apply(config_, record->after, record->sample);
  }
  const Stamp oldest = newest().stamp - from_seconds(config_.history);
  while (records_.size() > 1 && records_.front().after.stamp < oldest) {
    base_ = std::move(records_.front().after);
    records_.pop_front();
  }
}

std::optional<GlobalPose> Ekf::pose() const { return global_pose(newest()); }

std::optional<GlobalPose> Ekf::pose_at(Stamp stamp) const {
  const auto next = std::upper_bound(records_.begin(), records_.end(), stamp,
                                     [](Stamp s, const Record& record) { return s < record.after.stamp; });
  const Filter& a = next == records_.begin() ? base_ : std::prev(next)->after;
  if (!a.started || stamp < a.stamp) return std::nullopt;
  auto G = global_pose(a);
  if (!G || stamp == a.stamp) return G;
  if (next == records_.end()) {
    if (to_seconds(stamp - a.stamp) > config_.max_extrapolation) return std::nullopt;
    Filter ahead = a;
    predict_to(config_, ahead, stamp);
    return global_pose(ahead);
  }
  const Filter& b = next->after;
  Filter between = a;
  if (b.phase != a.phase || b.frame->origin() != a.frame->origin()) {
    predict_to(config_, between, stamp);
    return global_pose(between);
  }
  const double alpha = to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp);
  const Pose T = interpolate(make_pose(a.R, a.p), make_pose(b.R, b.p), alpha);
  between.p = T.translation();
  between.R = T.linear();
  between.P = (1.0 - alpha) * a.P + alpha * b.P;
  between.stamp = stamp;
  return global_pose(between);
}

EkfCounters Ekf::counters() const {
  EkfCounters all = newest().counters;
  all.imu_bad_value = refused_.imu_bad_value;
  all.imu_bad_time = refused_.imu_bad_time;
  all.wheel_bad_value = refused_.wheel_bad_value;
  all.wheel_bad_time = refused_.wheel_bad_time;
  all.fix_bad_time = refused_.fix_bad_time;
  return all;
}

}  // namespace fleetmap::localization
