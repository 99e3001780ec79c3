#pragma once

#include <cstdint>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim {

/// The perfect map of `world`, in ENU: sample_surface() of its mesh without the points below the ground (the
/// feet of posts and walls), which no LiDAR can see.
cloud::PointCloud ground_truth(const World& world, double points_per_m2, std::uint64_t seed,
                               std::size_t max_points = 50'000'000);

}  // namespace fleetmap::sim
