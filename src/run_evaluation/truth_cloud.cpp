#include "truth_cloud.hpp"

#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/sim/ground_truth.hpp"
#include "fleetmap/sim/mesh.hpp"
#include "fleetmap/sim/mesh_file.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::run_evaluation {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTruth = 10'000'000;  // points

/// A PLY whose header says that it has faces.
bool is_mesh(const fs::path& file) {
  if (file.extension() == ".obj") return true;
  if (file.extension() != ".ply") return false;
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (int k = 0; k < 200 && std::getline(in, line) && !line.starts_with("end_header"); ++k) {
    std::istringstream words(line);
    std::string element, face;
    long long count = 0;
    if (words >> element >> face >> count && element == "element" && face == "face" && count > 0) return true;
  }
  return false;
}

}  // namespace

Result<cloud::PointCloud> truth_cloud(const fs::path& file, double points_per_m2) {
  const auto unless_empty = [&](cloud::PointCloud cloud) -> Result<cloud::PointCloud> {
    if (cloud.empty()) return failure(file.string() + ": the mesh has no surface");
    return cloud;
  };
  if (file.extension() == ".yaml" || file.extension() == ".yml") {
    const auto world = config::make_world(file);
    if (!world) return tl::unexpected(world.error());
    return unless_empty(sim::ground_truth(**world, points_per_m2, 1, kMaxTruth));
  }
  if (!is_mesh(file)) return cloud::read_cloud(file);
  const auto mesh = sim::read_mesh(file);
  if (!mesh) return tl::unexpected(mesh.error());
  return unless_empty(sim::sample_surface(*mesh, points_per_m2, 1, kMaxTruth));
}

}  // namespace fleetmap::run_evaluation
