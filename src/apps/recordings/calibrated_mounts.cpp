#include "calibrated_mounts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/sensor/antenna_calibration.hpp"
#include "fleetmap/sensor/imu_calibration.hpp"
#include "fleetmap/sensor/wheel_calibration.hpp"

namespace fleetmap::apps {
namespace {

constexpr std::array kAxes{"x", "y", "z"};
constexpr char kEights[] = "drive two figures of eight";
constexpr char kTilts[] = "flat ground does not show it: measure it, or drive over kerbs and slopes";
constexpr double kMaxScaleSigma = 0.02;
constexpr double kMilli = 1e3;
// 1 sigma of errors that all steps of a drive share, so that their scatter does not show them: beams that are
// not where the model has them, a map that is bent (docs/journal/sensors_2026_11.md).
constexpr double kSharedShift = 0.003, kSharedTurn = 0.03 * kDegree;  // m, rad
// 1 sigma of the same in the height of the IMU, which small tilts show: slopes bend the LiDAR's attitude as
// well.
constexpr double kSharedHeight = 0.03;  // m
// Beyond it the axes of the mounts in use are not those of the new base_link.
constexpr double kMaxBaseTurn = 30.0 * kDegree;

double sigma_of(const Eigen::MatrixXd& covariance, Eigen::Index k) { return std::sqrt(covariance(k, k)); }

/// `covariance` is that of a translation and, if it has six rows, a rotation.
Eigen::MatrixXd with_shared_errors(Eigen::MatrixXd covariance) {
  covariance.diagonal().head<3>().array() += kSharedShift * kSharedShift;
  if (covariance.rows() == 6) covariance.diagonal().tail<3>().array() += kSharedTurn * kSharedTurn;
  return covariance;
}

class Collector {
 public:
  explicit Collector(const SensorPlaces& in_use) : in_use_(in_use) {}

  void add_wheels(sensor::WheelCalibration found) {
    found.covariance = with_shared_errors(found.covariance);
    Eigen::Vector3d turn = so3_log(found.T_wheels_base.linear());
    const std::array<bool, 3> turned = add_turns("LiDAR", turn, found.covariance);
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (!turned.at(static_cast<std::size_t>(k))) turn[k] = 0.0;
    }
    // The LiDAR's place is o + R p, so errors of R move it, too.
    const Eigen::Vector3d from_base = so3_exp(turn) * in_use_.T_base_lidar.translation();
    Eigen::Vector3d shift = found.T_wheels_base.translation() + from_base;
    Matrix6d by_turn = Matrix6d::Identity();
    by_turn.topRightCorner<3, 3>() = -skew(from_base);
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (!turned.at(static_cast<std::size_t>(k)))
        by_turn.col(k + 3).head<3>().setZero();  // the turn is kept
    }
    found.covariance = by_turn * found.covariance * by_turn.transpose();
    std::array<bool, 3> moved =
        add_shifts("LiDAR", shift, in_use_.T_base_lidar.translation(), found.covariance);
    // The axis about which a body sways is not known.
    moved[2] = quantities_.back().observable = false;
    quantities_.back().remedy = "wheels do not show it: measure it";
    add("wheels", "speed", "times that of the LiDAR", found.speed_scale, 1.0, kMaxScaleSigma);
    shift = kept(shift, in_use_.T_base_lidar.translation(), moved);
    place("lidar", true, make_pose(so3_exp(turn) * in_use_.T_base_lidar.linear(), shift), found.covariance,
          turned, moved);
    T_new_base_ = places_.back().T_base_sensor * in_use_.T_base_lidar.inverse();
  }

  void add_imu(sensor::ImuCalibration found) {
    found.covariance = with_shared_errors(found.covariance);
    found.covariance(2, 2) += kSharedHeight * kSharedHeight;
    const Eigen::Matrix3d R_in_use = in_use_.T_base_imu.linear();
    std::array<bool, 3> turned =
        add_turns("IMU", so3_log(found.T_base_imu.linear() * R_in_use.transpose()), found.covariance);
    const std::array<bool, 3> moved =
        add_shifts("IMU", found.T_base_imu.translation(), in_use_.T_base_imu.translation(), found.covariance);
    add_delay("IMU", found.delay);
    // Rotations about one axis that is known and one that is not have no roll, pitch and yaw.
    const bool all_turned = std::ranges::all_of(turned, [](bool one) { return one; });
    if (!all_turned) turned.fill(false);
    place("imu", true,
          make_pose(all_turned ? found.T_base_imu.linear() : R_in_use,
                    kept(found.T_base_imu.translation(), in_use_.T_base_imu.translation(), moved)),
          found.covariance, turned, moved);
  }

  void add_antenna(sensor::AntennaCalibration found) {
    found.covariance = with_shared_errors(found.covariance);
    const std::array<bool, 3> moved =
        add_shifts("GPS antenna", found.p_base_antenna, in_use_.p_base_antenna, found.covariance);
    add_delay("GPS", found.delay);
    place(
        "gps", false,
        make_pose(Eigen::Quaterniond::Identity(), kept(found.p_base_antenna, in_use_.p_base_antenna, moved)),
        found.covariance, {true, true, true}, moved);
  }

  void skip(const std::string& sensor, const Error& why) {
    skipped_.push_back(sensor + ": not observable on this drive, " + why.message + ": " + kEights);
  }

  CalibratedMounts finish() {
    // The new base_link is that of the wheels.
    const auto is_old = [](const CalibratedPlace& place) { return place.section != "lidar"; };
    if (so3_log(T_new_base_.linear()).norm() > kMaxBaseTurn && std::erase_if(places_, is_old) > 0) {
      skipped_.emplace_back(
          "IMU and GPS antenna: no mounts, since the LiDAR is turned too far against its mount in use: set "
          "the "
          "LiDAR's lines and calibrate again");
    }
    const Eigen::Matrix3d R = T_new_base_.linear();
    for (CalibratedPlace& place : places_) {
      if (!is_old(place)) continue;
      place.T_base_sensor = T_new_base_ * place.T_base_sensor;
      for (Eigen::Index k = 0; k < place.covariance.rows(); k += 3) {
        place.covariance.middleRows<3>(k) = R * place.covariance.middleRows<3>(k).eval();
        place.covariance.middleCols<3>(k) = place.covariance.middleCols<3>(k).eval() * R.transpose();
      }
    }
    return {0.0, 0.0, std::move(quantities_), std::move(places_), std::move(skipped_)};
  }

 private:
  bool add(const std::string& sensor, const std::string& name, const std::string& unit,
           const sensor::Calibrated& estimate, double in_use, double max_sigma,
           const char* remedy = kEights) {
    const bool observable = estimate.sigma < max_sigma;
    quantities_.push_back({sensor, name, unit, estimate, in_use, observable, observable ? "" : remedy});
    return observable;
  }

  std::array<bool, 3> add_turns(const std::string& sensor, const Eigen::Vector3d& turn,
                                const Eigen::MatrixXd& covariance) {
    std::array<bool, 3> observable{};
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      observable.at(axis) =
          add(sensor, std::string("turn about ") + kAxes.at(axis) + " against its mount in use", "deg",
              {turn[k] / kDegree, sigma_of(covariance, k + 3) / kDegree}, 0.0,
              sensor::kMaxRotationSigma / kDegree);
    }
    return observable;
  }

  std::array<bool, 3> add_shifts(const std::string& sensor, const Eigen::Vector3d& found,
                                 const Eigen::Vector3d& in_use, const Eigen::MatrixXd& covariance) {
    std::array<bool, 3> observable{};
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      observable.at(axis) = add(sensor, kAxes.at(axis), "m", {found[k], sigma_of(covariance, k)}, in_use[k],
                                sensor::kMaxLeverSigma, k == 2 ? kTilts : kEights);
    }
    return observable;
  }

  void add_delay(const std::string& sensor, const sensor::Calibrated& delay) {
    add(sensor, "delay of the stamps behind the LiDAR's", "ms", {kMilli * delay.value, kMilli * delay.sigma},
        0.0, kMilli * sensor::kMaxDelaySigma, "drive faster and slower, and in eights");
  }

  static Eigen::Vector3d kept(Eigen::Vector3d found, const Eigen::Vector3d& in_use,
                              const std::array<bool, 3>& observable) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (!observable.at(static_cast<std::size_t>(k))) found[k] = in_use[k];
    }
    return found;
  }

  void place(const std::string& section, bool with_rotation, const Pose& T, const Eigen::MatrixXd& covariance,
             const std::array<bool, 3>& turned, const std::array<bool, 3>& moved) {
    std::string names;
    const auto name = [&](const std::string& one) { names += (names.empty() ? "" : ", ") + one; };
    for (std::size_t k = 0; k < 3; ++k) {
      if (!moved.at(k)) name(kAxes.at(k));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (!turned.at(k)) name(std::string("turn about ") + kAxes.at(k));
    }
    const bool none = std::ranges::none_of(moved, [](bool one) { return one; }) &&
                      (!with_rotation || std::ranges::none_of(turned, [](bool one) { return one; }));
    if (!none) places_.push_back({section, with_rotation, T, covariance, names});
  }

  const SensorPlaces& in_use_;
  Pose T_new_base_ = Pose::Identity();
  std::vector<CalibratedQuantity> quantities_;
  std::vector<CalibratedPlace> places_;
  std::vector<std::string> skipped_;
};

}  // namespace

bool CalibratedQuantity::differs() const {
  return observable && std::abs(estimate.value - in_use) > 3.0 * estimate.sigma;
}

CalibratedMounts calibrate_mounts(const sensor::CalibrationDrive& drive, const SensorPlaces& in_use) {
  Collector all(in_use);
  if (const auto wheels = sensor::calibrate_wheels(drive)) {
    all.add_wheels(*wheels);
  } else {
    all.skip("LiDAR against the wheels", wheels.error());
  }
  if (const auto imu = sensor::calibrate_imu(drive, in_use.T_base_imu)) {
    all.add_imu(*imu);
  } else {
    all.skip("IMU", imu.error());
  }
  if (const auto antenna = sensor::calibrate_antenna(drive, in_use.p_base_antenna)) {
    all.add_antenna(*antenna);
  } else {
    all.skip("GPS antenna", antenna.error());
  }
  CalibratedMounts mounts = all.finish();
  for (std::size_t k = 1; k < drive.track.size(); ++k) {
    const Pose T_last_now = drive.track[k - 1].T_odom_base.inverse() * drive.track[k].T_odom_base;
    mounts.metres += T_last_now.translation().norm();
    mounts.turned += so3_log(T_last_now.linear()).norm();
  }
  return mounts;
}

}  // namespace fleetmap::apps
