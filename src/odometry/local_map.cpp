#include "fleetmap/odometry/local_map.hpp"

#include <algorithm>

namespace fleetmap::odometry {
namespace {

/// Distance of the points that enter the coarser windows, as a share of their step.
constexpr double kCoarseSpacing = 0.3;
constexpr double kLineThickness = 0.1;                    // m
const Eigen::Vector3f kNoSide = Eigen::Vector3f::Zero();  // of a line

}  // namespace

LocalMap::LocalMap(const LoamConfig& config)
    : fine_(config.fine_resolution, SurfaceGrid::Seeks::kPlanes, std::max(0.08, 3.0 * config.range_noise),
            0.0),
      coarse_(config.coarse_resolution, SurfaceGrid::Seeks::kPlanes, std::max(0.15, 4.0 * config.range_noise),
              config.coarse_noise),
      posts_(0.6 * config.fine_resolution, SurfaceGrid::Seeks::kUprightLines, kLineThickness, 0.0),
      edges_(config.fine_resolution, SurfaceGrid::Seeks::kLines, kLineThickness, 0.0),
      coarse_thinning_(kCoarseSpacing * config.coarse_resolution) {}

void LocalMap::add_surfaces(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& sensor) {
  observed_.clear();
  for (const Eigen::Vector3d& point : points) {
    observed_.push_back({point, (sensor - point).normalized().cast<float>()});
  }
  fine_.add(observed_);
  // A coarser window has enough of a fraction of them.
  thin_.clear();
  coarse_thinning_.clear();
  std::ranges::copy_if(observed_, std::back_inserter(thin_),
                       [this](const SurfaceGrid::ObservedPoint& observed) {
                         return coarse_thinning_.first_in_cube(observed.point.cast<float>());
                       });
  coarse_.add(thin_);
  // Posts are looked for only where no plane is.
  std::erase_if(observed_, [this](const SurfaceGrid::ObservedPoint& observed) {
    return fine_.known_plane(observed.point);
  });
  for (SurfaceGrid::ObservedPoint& observed : observed_) observed.toward = kNoSide;
  posts_.add(observed_);
}

void LocalMap::add_edges(std::span<const Eigen::Vector3d> points) {
  observed_.clear();
  for (const Eigen::Vector3d& point : points) observed_.push_back({point, kNoSide});
  edges_.add(observed_);
}

const Surface* LocalMap::surface_at(const Eigen::Vector3d& point, const Eigen::Vector3d& sensor) {
  const Eigen::Vector3f toward = (sensor - point).normalized().cast<float>();
  const Surface* fine = fine_.at(point, toward);
  if (fine != nullptr && fine->shape == Shape::kPlane) return fine;
  const Surface* post = fine != nullptr ? posts_.at(point, kNoSide) : nullptr;
  if (post != nullptr && post->shape == Shape::kLine) return post;
  if (fine != nullptr && fine->shape == Shape::kScatter) return nullptr;
  const Surface* coarse = coarse_.at(point, toward);
  return coarse != nullptr && coarse->shape == Shape::kPlane ? coarse : nullptr;
}

const Surface* LocalMap::edge_at(const Eigen::Vector3d& point) {
  const Surface* edge = edges_.at(point, kNoSide);
  return edge != nullptr && edge->shape == Shape::kLine ? edge : nullptr;
}

void LocalMap::prune(const Eigen::Vector3d& center, double radius) {
  fine_.prune(center, radius);
  coarse_.prune(center, radius);
  posts_.prune(center, radius);
  edges_.prune(center, radius);
}

LocalMapSize LocalMap::size() const {
  LocalMapSize size;
  for (const SurfaceGrid* grid : {&fine_, &coarse_, &posts_, &edges_}) {
    size.windows += grid->windows();
    size.bytes += grid->bytes();
  }
  return size;
}

void LocalMap::clear() {
  fine_.clear();
  coarse_.clear();
  posts_.clear();
  edges_.clear();
}

}  // namespace fleetmap::odometry
