#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/output/trajectory_file.hpp"

namespace fleetmap::eval {

using output::StampedPose;
using output::Trajectory;

/// The pose at `stamp`, interpolated; nothing outside the trajectory or in a gap longer than a second.
std::optional<Pose> pose_at(const Trajectory& trajectory, Stamp stamp);

/// Absolute and relative errors of one trajectory (ATE and RPE, Sturm et al., IROS 2012).
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

/// A robot's estimated and true poses.
struct Track {
  const Trajectory* estimate = nullptr;
  const Trajectory* truth = nullptr;
};
/// All robots' positions at once, RMS in m. Squares add up: unaligned^2 = georeference^2 + joint^2 and
/// joint^2 = between_robots^2 + within_robots^2.
struct FleetErrors {
  std::size_t poses = 0;
  double unaligned = 0.0;       ///< both are georeferenced
  double joint = 0.0;           ///< after the best single rigid transform of the whole fleet: joint ATE
  double georeference = 0.0;    ///< taken away by that transform: the fleet's map lies elsewhere as a whole
  double between_robots = 0.0;  ///< taken away besides by a rigid transform for each robot
  double within_robots = 0.0;   ///< the rest: the distortion of each robot's own track
};
/// Fails with fewer than three matches in all. A robot with fewer than three counts with the others only.
Result<FleetErrors> compare_jointly(std::span<const Track> tracks);

}  // namespace fleetmap::eval
