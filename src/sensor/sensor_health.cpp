#include "fleetmap/sensor/sensor_health.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "fleetmap/core/receive_buffer.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "force_unit.hpp"
#include "short_number.hpp"

namespace fleetmap::sensor {
namespace {

constexpr std::size_t kFirstNorms = 25;
constexpr double kNoAccelerometer = 0.05;  // m/s^2: the field is not filled
/// No ground robot turns that fast, and one that turns by 8 deg/s seems to if the unit is deg/s.
constexpr double kImpossibleRate = 8.0;  // rad/s
constexpr int kImpossibleRates = 5;      // in a row; a single one is an error of the sensor
constexpr Duration kLongerThanAShock = std::chrono::milliseconds(40);
constexpr double kTurns = 0.05;  // rad/s
constexpr std::size_t kComparedRates = 50;
constexpr Duration kSameMoment = std::chrono::milliseconds(200);
constexpr Duration kLongStep = std::chrono::seconds(1);
constexpr double kMoves = 1e-4;     // m or rad within a step
constexpr double kMaxSpeed = 20.0;  // m/s
constexpr Duration kShortestSweep = std::chrono::milliseconds(5);
constexpr double kPause = 100.0;   // sweeps: the LiDAR was off
constexpr double kMissing = 1.75;  // sweeps from scan to scan
constexpr double kMissingShare = 0.1;
constexpr std::uint64_t kMinScansChecked = 40;
/// Share of the intervals between scans without point times that may be shorter than a sweep.
constexpr double kUsualShare = 0.1;
constexpr std::uint64_t kScansPerGround = 5;
constexpr std::size_t kGrounds = 40;
constexpr Duration kImuGap = std::chrono::milliseconds(250), kPauseOfImu = std::chrono::seconds(10);
constexpr Duration kMinGapObservation = std::chrono::seconds(10);
constexpr double kGapShare = 0.1;
constexpr double kSteepest = 25.0 * kDegree;  // slope on which a robot starts
constexpr double kLevel = 5.0 * kDegree;      // tilt of the ground in base_link

/// Component by component, which ground that is seen askew now and then does not shift.
Eigen::Vector3d median(std::vector<Eigen::Vector3d> vectors) {
  Eigen::Vector3d middle;
  const auto half = vectors.begin() + static_cast<std::ptrdiff_t>(vectors.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::nth_element(vectors, half, {}, [axis](const Eigen::Vector3d& v) { return v[axis]; });
    middle[axis] = (*half)[axis];
  }
  return middle.normalized();
}

/// The mean of the intervals around the shortest ones, of which stamps that jitter make some too short.
Duration shortest_usual(std::vector<Duration> intervals) {
  std::ranges::sort(intervals);
  Duration usual = intervals[static_cast<std::size_t>(kUsualShare * static_cast<double>(intervals.size()))];
  for (int pass = 0; pass < 3; ++pass) {
    const auto end = std::ranges::upper_bound(intervals, usual * 3 / 2);
    usual = std::accumulate(intervals.begin(), end, Duration{}) / (end - intervals.begin());
  }
  return usual;
}

}  // namespace

void SensorHealth::state(std::string finding) {
  if (std::ranges::find(findings_, finding) == findings_.end()) findings_.push_back(std::move(finding));
}

void SensorHealth::add_note(std::string note) {
  if (std::ranges::find(findings_, note) != findings_.end()) return;
  notes_.push_back(note);
  findings_.push_back(std::move(note));
}

std::vector<std::string> SensorHealth::alarms() const {
  std::vector<std::string> alarms;
  std::ranges::copy_if(findings_, std::back_inserter(alarms), [this](const std::string& finding) {
    return std::ranges::find(notes_, finding) == notes_.end();
  });
  return alarms;
}

bool SensorHealth::refuse() {
  ++refused_;
  return false;
}

std::vector<std::string> SensorHealth::take_warnings() {
  std::vector<std::string> news(findings_.begin() + static_cast<std::ptrdiff_t>(reported_), findings_.end());
  reported_ = findings_.size();
  return news;
}

bool SensorHealth::check(Imu& imu) {
  check_gaps(imu.stamp);
  if (!last_scan_) {
    silences_.pass(imu.stamp, std::nullopt);
    state_silences();
  }
  correct_force(imu);
  check_gravity(imu);
  if (!correct_rate(imu)) return refuse();
  motion_.add(imu);
  return true;
}

void SensorHealth::set_imu_rotation(const Eigen::Quaterniond& q_base_imu) {
  q_base_imu_ = q_base_imu;
  motion_.set_imu_rotation(q_base_imu);
}

void SensorHealth::check_motion(Stamp stamp, const std::optional<Pose>& T_odom_base) {
  if (!T_odom_base) {
    silences_.pass_lost(stamp);
    state_silences();
    motion_.interrupt();
    return gps_.interrupt();
  }
  silences_.pass(stamp, Eigen::Vector3d(T_odom_base->translation()));
  state_silences();
  motion_.add_motion(stamp, *T_odom_base);
  gps_.add_motion(stamp, *T_odom_base);
  for (std::string& finding : motion_.take_findings()) state(std::move(finding));
  for (std::string& finding : gps_.take_findings()) state(std::move(finding));
}

void SensorHealth::check_gaps(Stamp stamp) {
  const std::optional<Stamp> before = std::exchange(last_imu_, stamp);
  if (!first_imu_) first_imu_ = stamp;
  if (!before || stamp <= *before || imu_gaps_reported_) return;
  if (stamp - *before > kPauseOfImu) first_imu_ = stamp;  // it was off
  if (stamp - *before > kImuGap && stamp - *before <= kPauseOfImu) imu_gaps_ += to_seconds(stamp - *before);
  const double heard = to_seconds(stamp - *first_imu_);
  if (stamp - *first_imu_ < kMinGapObservation || imu_gaps_ < kGapShare * heard) return;
  imu_gaps_reported_ = true;
  state("IMU: samples are missing: " + short_number(100.0 * imu_gaps_ / heard) +
        " % of the time is in gaps of more than 0.25 s, in which the motion is not measured. Check its "
        "cable, the load of the computer and the rate of the driver (100 Hz)");
}

void SensorHealth::check_gravity(const Imu& imu) {
  if (first_forces_.size() >= kFirstNorms || !(imu.specific_force.norm() > kNoAccelerometer)) return;
  first_forces_.push_back((q_base_imu_ * imu.specific_force).normalized());
  if (first_forces_.size() < kFirstNorms) return;
  const Eigen::Vector3d up = median(first_forces_);
  const double tilt = std::acos(std::clamp(up.z(), -1.0, 1.0));
  if (tilt < kSteepest) return;
  const Eigen::Vector3d turn = rpy_from_rotation(levelling(up)) / kDegree;
  state("IMU: gravity is " + short_number(tilt / kDegree) +
        " deg off base_link's z at the start, so the IMU is not mounted as imu.rotation_rpy_deg says: it "
        "should be turned by [" +
        short_number(turn.x()) + ", " + short_number(turn.y()) +
        ", 0] deg more; or its axes are swapped. Gravity does not show yaw: its 0 is assumed, so compare the "
        "IMU's x with base_link's");
}

void SensorHealth::correct_force(Imu& imu) {
  const double norm = imu.specific_force.norm();
  if (force_scale_) {
    imu.specific_force *= *force_scale_;
    return;
  }
  if (!std::isfinite(norm)) return;
  // Until the unit is decided, each sample stands for itself.
  if (const ForceUnit* unit = force_unit_of(norm)) imu.specific_force *= unit->scale;
  first_norms_.push_back(norm);
  if (first_norms_.size() < kFirstNorms) return;
  std::ranges::nth_element(first_norms_, first_norms_.begin() + kFirstNorms / 2);
  const double median = first_norms_[kFirstNorms / 2];
  const ForceUnit* unit = force_unit_of(median);
  force_scale_ = unit ? unit->scale : 1.0;
  if (median <= kNoAccelerometer) {
    state(
        "IMU: the acceleration is 0 at the start: it is not filled, or gravity was taken out; roll and pitch "
        "are not measured. Let the driver report the specific force");
  } else if (!unit) {
    state("IMU: the acceleration is " + short_number(median) +
          " at the start, which gravity is in no known unit; the attitude will be wrong. Correct the "
          "driver's scale, or leave the topic away");
  } else if (unit->scale != 1.0) {
    state("IMU: the acceleration is " + short_number(median) + " at the start, so its unit is " + unit->name +
          " and not m/s^2; it is converted. Correct the driver");
  }
}

void SensorHealth::expect_degrees(const std::string& why) {
  gyro_in_degrees_ = why;
  state("IMU: " + why +
        ", so the unit of the angular velocity is deg/s and not rad/s; it is converted. Correct the driver");
}

bool SensorHealth::gyro_unit_decided() const {
  return gyro_in_degrees_.has_value() || compared_rates_ >= kComparedRates;
}

bool SensorHealth::correct_rate(Imu& imu) {
  const double rate = imu.angular_velocity.norm();
  if (gyro_in_degrees_) {
    imu.angular_velocity *= kDegree;
    return true;
  }
  const auto in_degrees = [&](const std::string& why) {
    expect_degrees(why);
    imu.angular_velocity *= kDegree;
    return true;
  };
  const bool with_wheels = last_wheel_ && last_wheel_->yaw_rate &&
                           imu.stamp - last_wheel_->stamp < kSameMoment &&
                           std::abs(*last_wheel_->yaw_rate) > kTurns;
  if (with_wheels) {
    const double by_wheels = std::abs(*last_wheel_->yaw_rate);
    wheel_squares_ += by_wheels * by_wheels;
    products_ += rate * by_wheels;
    const double slope = products_ / wheel_squares_;
    ++compared_rates_;
    if (slope > 30.0 && slope < 100.0) {
      if (compared_rates_ < kComparedRates) return false;
      return in_degrees("it turns " + short_number(slope) + " times as fast as the wheels");
    }
  }
  if (rate <= kImpossibleRate) {
    impossible_rates_ = 0;
    return true;
  }
  if (++impossible_rates_ == 1) impossible_since_ = imu.stamp;
  if (impossible_rates_ < kImpossibleRates || imu.stamp - impossible_since_ < kLongerThanAShock) return false;
  return in_degrees("it turns at " + short_number(rate) + " rad/s, which no ground robot does");
}

bool SensorHealth::check(Wheel& wheel) {
  const bool sound = correct_twist(wheel) || refuse();
  if (!sound) return false;
  silences_.add_wheel(wheel.stamp);
  motion_.add(wheel);
  return true;
}

bool SensorHealth::correct_twist(Wheel& wheel) {
  const std::optional<Wheel> before = std::exchange(last_wheel_, wheel);
  const bool is_stationary = wheel.forward_speed == 0.0 && wheel.yaw_rate.value_or(0.0) == 0.0;
  if (!is_stationary || !before || !before->T_odom_base || !wheel.T_odom_base) return true;
  const Duration step = wheel.stamp - before->stamp;
  if (step <= Duration::zero() || step > kLongStep) return true;
  const Pose T_before_now = before->T_odom_base->inverse() * *wheel.T_odom_base;
  const Eigen::Vector3d turn = so3_log(T_before_now.linear());
  if (T_before_now.translation().norm() < kMoves && turn.norm() < kMoves) return true;
  if (!std::exchange(speed_from_pose_, true))
    state(
        "wheel odometry: its pose moves while its twist is zero; the speed is taken from the pose. Let the "
        "driver fill the twist, or name the topic of the wheels");
  wheel.forward_speed = T_before_now.translation().x() / to_seconds(step);
  wheel.yaw_rate = turn.z() / to_seconds(step);
  last_wheel_->yaw_rate = wheel.yaw_rate;
  return std::abs(wheel.forward_speed) < kMaxSpeed;
}

bool SensorHealth::check(Fix& fix) {
  const GeoPoint& p = fix.position;
  const bool somewhere =
      std::isfinite(p.latitude) && std::isfinite(p.longitude) && (p.latitude != 0.0 || p.longitude != 0.0);
  if (std::isfinite(p.latitude) && !somewhere && fix.valid && !std::exchange(no_place_, true))
    state(
        "GPS: fixes are at latitude 0, longitude 0: the receiver reports them before it knows its place; "
        "they are refused. Let its driver set status -1");
  if (!somewhere && fix.valid) return refuse();
  const bool flat = somewhere && !std::isfinite(p.altitude);
  if (!flat) {
    if (fix.valid && fix.above_sea_level && !std::exchange(above_sea_level_, true))
      state(
          "GPS: heights are above mean sea level, since the receiver states none above the ellipsoid: "
          "the map is up to 100 m lower or higher than those of other robots. Set gps.geoid: egm2008-5 where "
          "the receiver is read, on all robots, or let the receiver state the height of the geoid");
    fix.valid ? silences_.add_fix(fix.stamp) : silences_.add_empty_fix();
    gps_.add(fix);
    fix.position.altitude -= gps_.height_correction();
    return true;
  }
  if (!std::exchange(no_altitude_, true))
    state(
        "GPS: fixes have no altitude and cannot be used; let the receiver or its driver report the height "
        "above the ellipsoid");
  return refuse();
}

void SensorHealth::check_scan(Stamp stamp, Duration sweep) {
  const std::optional<Stamp> before = std::exchange(last_scan_, stamp);
  if (!before || stamp <= *before) return;
  const Duration interval = stamp - *before;
  if (sweep >= kShortestSweep) return count_scan(interval, sweep);
  if (usual_interval_) return count_scan(interval, *usual_interval_);
  first_intervals_.push_back(interval);
  if (first_intervals_.size() < kMinScansChecked) return;
  usual_interval_ = std::max(shortest_usual(first_intervals_), kShortestSweep);
  for (const Duration first : first_intervals_) count_scan(first, *usual_interval_);
}

void SensorHealth::count_scan(Duration interval, Duration sweep) {
  const double sweeps = to_seconds(interval) / to_seconds(sweep);
  if (sweeps > kPause) return;
  ++scans_;
  // Half a sweep is what a cropped cloud may lack.
  if (sweeps > kMissing) missing_scans_ += static_cast<std::uint64_t>(std::lround(sweeps)) - 1;
  const auto all = static_cast<double>(scans_ + missing_scans_);
  if (scans_missing_ || scans_ < kMinScansChecked ||
      static_cast<double>(missing_scans_) < kMissingShare * all)
    return;
  scans_missing_ = true;
  state("LiDAR: " + std::to_string(missing_scans_) + " of " + std::to_string(scans_ + missing_scans_) +
        " scans are missing: " + (usual_interval_ ? "the closest are " : "a sweep takes ") +
        short_number(to_seconds(sweep)) + (usual_interval_ ? " s apart" : " s") + ", and one came every " +
        short_number(to_seconds(sweep) * all / static_cast<double>(scans_)) + " s. Use a wire, or " +
        kRaiseReceiveBuffer + "; if the driver crops the cloud, ignore this");
}

bool SensorHealth::ground_due() {
  return grounds_.size() < kGrounds && scans_for_ground_++ % kScansPerGround == 0;
}

void SensorHealth::check_ground(const Eigen::Vector3d& normal) {
  if (grounds_.size() == kGrounds) return;
  grounds_.push_back(normal);
  if (grounds_.size() < kGrounds) return;
  const Eigen::Vector3d up = median(grounds_);
  const double tilt = std::acos(std::min(1.0, up.z()));
  if (tilt < kLevel) return;
  const Eigen::Vector3d turn = rpy_from_rotation(levelling(up)) / kDegree;
  state("LiDAR: the ground is tilted by " + short_number(tilt / kDegree) +
        " deg in base_link, in the median of " + std::to_string(kGrounds) +
        " scans, so the LiDAR is not mounted as lidar.rotation_rpy_deg says: it should be turned by [" +
        short_number(turn.x()) + ", " + short_number(turn.y()) + ", 0] deg more");
}

}  // namespace fleetmap::sensor
