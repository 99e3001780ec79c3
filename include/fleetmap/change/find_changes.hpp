#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fleetmap/change/change_config.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::change {

/// Points that a robot saw from about one place.
struct ObservedSubmap {
  cloud::PointCloud points;                          ///< in the map's frame
  Eigen::Vector3f sensor = Eigen::Vector3f::Zero();  ///< in the map's frame: the middle of its way
};

/// Direction of a change from the earlier to the later map.
enum class Kind : std::uint8_t { appeared, disappeared };
const char* to_string(Kind kind);

/// An object that is in one of two maps, where the other day saw through its place.
struct Change {
  Kind kind = Kind::appeared;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, in the map's frame
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< m: length and width, horizontal, and height
  double heading_rad = 0.0;                          ///< of its length, counter-clockwise from x
  std::size_t cells = 0;                             ///< of its surface
  std::size_t traversed = 0;                         ///< of these, cells that the other day saw through
  std::vector<Eigen::Vector3f> points;               ///< one a cell
  /// [0, 1]: 1 less the size of the largest false change within one day over `traversed`.
  double confidence = 0.0;
  /// Share of its surface that the other day saw through, [0, 1]. The rest is hidden, or against the sky.
  double traversed_share() const { return static_cast<double>(traversed) / static_cast<double>(cells); }
};

/// Result of find_changes(): changes in the map's frame, and the noise by which they were found.
struct Changes {
  std::vector<Change> changes;  ///< largest first
  double noise_m = 0.0;         ///< m, median distance of a surface of one day to itself, seen from elsewhere
  double misfit_m = 0.0;        ///< m, the same between the two days
  double min_distance_m = 0.0;  ///< m, median distance from which surfaces count as different
  std::size_t min_cells = 0;    ///< size of the largest false change within one day, and one more
  std::size_t compared = 0;     ///< cells of either map that the other day saw, or saw through
  std::size_t unknown = 0;      ///< cells of either map that the other day did not see: no statement
  std::vector<Eigen::Vector3f> same;        ///< cells of `after` that were there before
  std::vector<Eigen::Vector3f> unobserved;  ///< those that are `unknown`
};

/// Compares two maps of a site that lie in one frame. A cell of one map is changed if no surface of the other
/// lies near, though several submaps of the other day saw through it (Girardeau-Montaut et al. 2005; the rays
/// are those of Moravec and Elfes 1985). A cell that the other day did not see is unknown.
///
/// From what distance on surfaces differ is estimated, tile by tile: each day is divided into two halves of
/// its submaps, whose 99th percentile of distances (noise, vegetation, movement) is scaled by how much worse
/// the two days fit than these halves. The least size of a change is larger than any change that the same
/// comparison finds between such halves, or between the earlier and the later half of one day. Things that
/// one submap alone saw, or that their own day saw through as well, moved and do not count. Fails, with the
/// reason, if the maps do not overlap.
Result<Changes> find_changes(std::span<const ObservedSubmap> before, std::span<const ObservedSubmap> after,
                             const ChangeConfig& config);

}  // namespace fleetmap::change
