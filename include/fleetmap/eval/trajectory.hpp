#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::eval {

struct StampedPose {
  Stamp stamp;
  Pose T_enu_base = Pose::Identity();
};
using Trajectory = std::vector<StampedPose>;

/// A TUM file: `stamp_s x y z qx qy qz qw`. Fails with file and line.
Result<Trajectory> read_tum(const std::filesystem::path& file);
Status write_tum(const std::filesystem::path& file, const Trajectory& trajectory);

struct TrajectoryErrors {
  std::size_t pairs = 0;
  double ate_rmse = 0.0;          ///< m, without alignment: both are georeferenced
  double ate_rmse_aligned = 0.0;  ///< m, after the best rigid transform (Umeyama)
  double ate_max = 0.0;           ///< m, without alignment
  double rpe_translation = 0.0;   ///< share of the path, over segments of `rpe_length`
  double rpe_rotation = 0.0;      ///< rad/m
  double rpe_length = 20.0;       ///< m
};
/// `estimate` against `truth`, poses matched by interpolating the truth at the estimate's stamps.
Result<TrajectoryErrors> compare(const Trajectory& estimate, const Trajectory& truth,
                                 double rpe_length = 20.0);

/// RMS of the error of where one robot sees another, over the stamps at which both are known: m.
struct InterRobotError {
  std::size_t pairs = 0;
  double translation_rmse = 0.0;  ///< m
  double rotation_rmse = 0.0;     ///< rad
};
Result<InterRobotError> compare_pairwise(const Trajectory& a, const Trajectory& b, const Trajectory& truth_a,
                                         const Trajectory& truth_b);

}  // namespace fleetmap::eval
