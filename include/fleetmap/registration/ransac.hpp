#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/registration/fpfh.hpp"
#include "fleetmap/registration/prior.hpp"

namespace fleetmap::registration {

struct RansacConfig {
  std::uint64_t seed = 1;  ///< same seed and input, same result
  int iterations = 4000;   ///< triples drawn
  float inlier_m = 1.0f;   ///< m, a correspondence within this of a hypothesis supports it
  float edge_tolerance_m =
      0.7f;                   ///< m, most difference of a length between two points in target and in source
  float min_edge_m = 4.0f;    ///< m, points of a triple are this far apart
  double prior_sigmas = 4.0;  ///< hypotheses further than this from the prior are rejected
  std::size_t max_hypotheses = 8;  ///< kept
  double distinct_m = 1.5;         ///< m, hypotheses nearer than this and `distinct_rad` are the same one
  double distinct_rad = 0.12;      ///< rad
  Status validate() const;
};

struct Hypothesis {
  Pose T_target_source = Pose::Identity();
  std::size_t support = 0;  ///< correspondences within inlier_m
};

/// Poses that many correspondences support, best first. Triples are drawn only among correspondences whose
/// lengths agree pairwise (edge-length prerejection, tabled once), so wrong correspondences cost little.
std::vector<Hypothesis> ransac(const cloud::PointCloud& target, const cloud::PointCloud& source,
                               const std::vector<Correspondence>& correspondences, const RansacConfig& config,
                               const std::optional<Prior>& prior);

/// Whether two poses are the same mode.
bool same_mode(const Pose& a, const Pose& b, double distinct_m, double distinct_rad);

}  // namespace fleetmap::registration
