#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "fleetmap/cloud/normals.hpp"
#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::registration {

inline constexpr int kFpfhSize = 33;
/// One feature a column. Columns of points without a normal or without neighbours are zero.
using Features = Eigen::Matrix<float, kFpfhSize, Eigen::Dynamic>;

/// Fast point feature histograms (Rusu 2009): three angles between the normals of neighbouring points, 11
/// bins each, averaged over the neighbourhood of `radius_m`. Each column holds the square roots of its
/// shares, so that Euclidean distance between columns is Hellinger distance between histograms, which one
/// dominant bin cannot rule.
Features compute_fpfh(const cloud::PointCloud& cloud, const cloud::Normals& normals, float radius_m);

/// Possible pair of points that are the same spot.
struct Correspondence {
  std::size_t target = 0;
  std::size_t source = 0;
};

struct MatchConfig {
  std::size_t max_keypoints =
      1500;  ///< per cloud: those whose features differ most from the cloud's mean feature
  std::size_t max_matches = 800;  ///< the most distinct ones are kept
};

/// Pairs of keypoints that are each other's nearest in feature space, the most distinct (least ratio of
/// nearest to second nearest distance) first.
std::vector<Correspondence> match_features(const Features& target, const Features& source,
                                           const MatchConfig& config);

}  // namespace fleetmap::registration
