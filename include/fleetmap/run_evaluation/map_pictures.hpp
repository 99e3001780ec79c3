#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/store/map_merge.hpp"

namespace fleetmap::run_evaluation {

/// A picture of a map as a PNG file.
struct MapPicture {
  std::string file;  ///< "map_top.png"
  std::string caption;
  std::vector<std::uint8_t> png;
};

/// map_top.png and map_perspective.png: each point in the colour of the robot that saw it first, brighter the
/// higher it is above the ground.
Result<std::vector<MapPicture>> pictures_by_robot(const store::MergedMap& map);
/// Positions of a robot in the map's frame, in order.
using Path = std::vector<Eigen::Vector3d>;
/// map_plan.png: the map from above in grey, brighter the higher it is above the ground, under the paths of
/// robots; `robots` runs parallel to `paths`.
Result<MapPicture> picture_with_paths(const cloud::PointCloud& map, const std::vector<std::string>& robots,
                                      const std::vector<Path>& paths);
/// map_error.png: distance to the truth; `errors` (m) runs parallel to the points.
Result<MapPicture> picture_of_errors(const cloud::PointCloud& points, const std::vector<float>& errors);
/// map_density.png: points within `radius` (m), Eq. 4; of the whole map, or of points of it with their
/// counts.
Result<MapPicture> picture_of_density(const cloud::PointCloud& map, double radius);
Result<MapPicture> picture_of_density(const cloud::PointCloud& shown,
                                      const std::vector<std::uint32_t>& counts, double radius);
/// Adds to each of `counts` how many of a tile's points lie within `radius` (m) of that point of `shown`.
void add_density(const cloud::PointCloud& shown, const cloud::PointCloud& tile, double radius,
                 std::vector<std::uint32_t>& counts);

/// Most points that are worth drawing.
inline constexpr std::size_t kMaxDrawn = 3'000'000;

Status write_picture(const std::filesystem::path& directory, const MapPicture& picture);

}  // namespace fleetmap::run_evaluation
