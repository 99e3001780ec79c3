#include "twin_results.hpp"

#include "fleetmap/cloud/file_io.hpp"
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

}  // namespace fleetmap::apps
