#include "twin_results.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/planning/site/geojson.hpp"
#include "fleetmap/planning/site/geojson_writer.hpp"
#include "fleetmap/sim/ground_truth.hpp"

namespace fleetmap::apps {
namespace {

constexpr double kPointsPerSquareMetre = 100.0;
constexpr std::size_t kMaxPoints = 8'000'000;
constexpr std::uint64_t kSeed = 1;

}  // namespace

Status write_truth(const std::filesystem::path& directory, const output::Trajectory& truth) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) return failure(directory.string() + ": cannot be made: " + error.message());
  return output::write_tum(directory / "truth.tum", truth);
}

Status write_truth_cloud(const std::filesystem::path& out, const sim::World& world) {
  return cloud::write_cloud(out / "truth.ply",
                            sim::ground_truth(world, kPointsPerSquareMetre, kSeed, kMaxPoints));
}

Status write_site(const std::filesystem::path& out, const TwinSetup& setup) {
  return planning::write_geojson(out / "site.geojson", setup.site, LocalFrame(setup.origin));
}

std::optional<double> share_of_lanes_driven(const sim::World& world, int every,
                                            const std::vector<output::Trajectory>& truths) {
  constexpr double kStep = 0.5;   // m along a lane
  constexpr double kReach = 5.0;  // m beside it
  const std::vector<sim::Aisle>& lanes = world.aisles();
  std::vector<std::vector<bool>> driven;
  for (const sim::Aisle& lane : lanes)
    driven.emplace_back(static_cast<std::size_t>(std::ceil((lane.to - lane.from).norm() / kStep)), false);
  for (const auto& truth : truths) {
    for (const output::StampedPose& pose : truth) {
      double nearest = kReach;
      std::optional<std::pair<std::size_t, std::size_t>> piece;  // of a lane
      for (std::size_t k = 0; k < lanes.size(); ++k) {
        const Eigen::Vector2d along = (lanes[k].to - lanes[k].from).normalized();
        const Eigen::Vector2d p = pose.T_w_base.translation().head<2>() - lanes[k].from;
        const double at = along.dot(p);
        const double beside = (p - at * along).norm();
        const auto index = static_cast<std::size_t>(std::max(0.0, at) / kStep);
        if (beside > nearest || at < 0.0 || index >= driven[k].size()) continue;
        nearest = beside;
        piece = {k, index};
      }
      if (piece) driven[piece->first][piece->second] = true;
    }
  }
  std::ptrdiff_t done = 0, all = 0;
  for (std::size_t k = 0; k < lanes.size(); k += static_cast<std::size_t>(std::max(1, every))) {
    done += std::ranges::count(driven[k], true);
    all += std::ssize(driven[k]);
  }
  if (all == 0) return std::nullopt;
  return static_cast<double>(done) / static_cast<double>(all);
}

}  // namespace fleetmap::apps
