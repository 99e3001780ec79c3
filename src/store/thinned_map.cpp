#include "fleetmap/store/thinned_map.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::store {
namespace {

constexpr std::size_t kMaxPointsAtOnce = 100'000;  ///< points added between two checks of the size

/// Points [begin, end).
cloud::PointCloud slice(const cloud::PointCloud& cloud, std::size_t begin, std::size_t end) {
  cloud::PointCloud part;
  const auto at = [](const auto& values, std::size_t i) {
    return values.begin() + static_cast<std::ptrdiff_t>(i);
  };
  part.points.assign(at(cloud.points, begin), at(cloud.points, end));
  if (cloud.has_intensities())
    part.intensities.assign(at(cloud.intensities, begin), at(cloud.intensities, end));
  return part;
}

}  // namespace

ThinnedMap::ThinnedMap(double voxel_m, std::size_t max_points)
    : voxel_m_(static_cast<float>(voxel_m)),
      max_points_(std::max<std::size_t>(1, max_points)),
      merger_(voxel_m_, cloud::VoxelPoint::first) {}

void ThinnedMap::add(const MapTile& tile) {
  for (std::size_t begin = 0; begin < tile.cloud.size();) {
    // Adds points of one agent at a time, because the merger returns how many it kept, not which.
    std::size_t end = begin;
    while (end < tile.cloud.size() && end - begin < kMaxPointsAtOnce &&
           tile.observed_by[end] == tile.observed_by[begin])
      ++end;
    observed_by_.insert(observed_by_.end(), merger_.add(slice(tile.cloud, begin, end)),
                        tile.observed_by[begin]);
    begin = end;
    while (merger_.voxels() > max_points_) {
      const MapTile held{merger_.cloud(), std::exchange(observed_by_, {})};
      voxel_m_ *= 1.5f;
      merger_ = cloud::VoxelMerger(voxel_m_, cloud::VoxelPoint::first);
      add(held);
    }
  }
}

MergedMap ThinnedMap::map(const MapOutline& outline) const {
  return {outline, merger_.cloud(), observed_by_};
}

}  // namespace fleetmap::store
