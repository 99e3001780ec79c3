#include "twin_results.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/planning/geojson.hpp"
#include "fleetmap/sim/ground_truth.hpp"

namespace fleetmap::apps {
namespace {

constexpr double kPointsPerSquareMetre = 100.0;
constexpr std::size_t kMaxPoints = 8'000'000;
constexpr std::uint64_t kSeed = 1;

}  // namespace

Status write_truth(const std::filesystem::path& directory, const std::vector<agent::StampedPose>& truth) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return failure(directory.string() + ": cannot be made: " + error.message());
  return agent::write_trajectory(directory / "truth.tum", truth);
}

Status write_truth_cloud(const std::filesystem::path& out, const sim::World& world) {
  return cloud::write_cloud(out / "truth.ply",
                            sim::ground_truth(world, kPointsPerSquareMetre, kSeed, kMaxPoints));
}

Status write_site(const std::filesystem::path& out, const TwinSetup& setup) {
  return planning::write_geojson(out / "site.geojson", setup.site, LocalFrame(setup.origin));
}

std::optional<double> share_of_lanes_driven(const sim::World& world, int every,
                                            const std::vector<std::vector<agent::StampedPose>>& truths) {
  constexpr double kStep = 0.5;   // m along a lane
  constexpr double kReach = 2.0;  // m
  double driven = 0.0, all = 0.0;
  for (std::size_t k = 0; k < world.aisles().size(); k += static_cast<std::size_t>(std::max(1, every))) {
    const sim::Aisle& lane = world.aisles()[k];
    const double length = (lane.to - lane.from).norm();
    const Eigen::Vector2d along = (lane.to - lane.from) / length;
    std::vector<bool> reached(static_cast<std::size_t>(std::ceil(length / kStep)), false);
    for (const auto& truth : truths) {
      for (const agent::StampedPose& pose : truth) {
        const Eigen::Vector2d p = pose.T_w_base.translation().head<2>() - lane.from;
        const double at = along.dot(p);
        if ((p - at * along).norm() > kReach || at < 0.0 || at >= length) continue;
        reached[static_cast<std::size_t>(at / kStep)] = true;
      }
    }
    driven += static_cast<double>(std::ranges::count(reached, true));
    all += static_cast<double>(reached.size());
  }
  if (all == 0.0) return std::nullopt;
  return driven / all;
}

}  // namespace fleetmap::apps
