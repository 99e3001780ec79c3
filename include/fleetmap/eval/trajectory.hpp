#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::eval {

struct StampedPose {
  Stamp stamp;
  Pose T_enu_base = Pose::Identity();
};
/// Stamps never go back.
using Trajectory = std::vector<StampedPose>;

/// A TUM file: `stamp_s x y z qx qy qz qw`; empty lines and those that begin with # are skipped. Fails with
/// file and line on anything else, on a number that is not finite, and where stamps go back.
Result<Trajectory> read_tum(const std::filesystem::path& file);
Status write_tum(const std::filesystem::path& file, const Trajectory& trajectory);

/// The pose at `stamp`, interpolated; nothing outside the trajectory or in a gap longer than a second.
std::optional<Pose> pose_at(const Trajectory& trajectory, Stamp stamp);

struct TrajectoryErrors {
  std::size_t pairs = 0;
  double ate_rmse = 0.0;          ///< m, without alignment: both are georeferenced
  double ate_rmse_aligned = 0.0;  ///< m, after the best rigid transform (Umeyama)
  double ate_max = 0.0;           ///< m, without alignment
  std::size_t rpe_segments = 0;   ///< of `rpe_length`; with none, both RPE are NaN
  double rpe_translation = 0.0;   ///< share of the path, mean over segments of `rpe_length`
  double rpe_rotation = 0.0;      ///< rad/m, mean over segments
  double rpe_length = 20.0;       ///< m, along the truth
  double path_length = 0.0;       ///< m, of the truth where it is compared
};
/// `estimate` against `truth`, poses matched by interpolating the truth at the estimate's stamps. Fails with
/// fewer than three matches.
Result<TrajectoryErrors> compare(const Trajectory& estimate, const Trajectory& truth,
                                 double rpe_length = 20.0);

/// RMS of the error of where one robot sees another, over the stamps at which both are known: m.
struct InterRobotError {
  std::size_t pairs = 0;
  double translation_rmse = 0.0;  ///< m
  double rotation_rmse = 0.0;     ///< rad
};
/// At the stamps of `a`; the others are interpolated. Fails when they share no time.
Result<InterRobotError> compare_pairwise(const Trajectory& a, const Trajectory& b, const Trajectory& truth_a,
                                         const Trajectory& truth_b);

}  // namespace fleetmap::eval
