#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sim/imu_spec.hpp"

namespace fleetmap::sim {

/// The truth of an IMU at one moment.
struct ImuMotion {
  Stamp stamp;
  Pose T_enu_imu = Pose::Identity();
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();  ///< m/s
};

/// Gyroscopes and accelerometers with bias random walk and white noise; each sample is the mean over the time
/// since the sample before, as devices integrate it. Deterministic in `seed`.
class ImuModel {
 public:
  ImuModel(const ImuSpec& spec, std::uint64_t seed);
  ~ImuModel();
  ImuModel(ImuModel&&) noexcept;
  /// The device's sample at now.stamp for the motion since `before`, which must be earlier.
  sensor::Imu measure(const ImuMotion& before, const ImuMotion& now);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::sim
