#include "fleetmap/eval/observed_places.hpp"

#include <cmath>
#include <unordered_map>
#include <vector>

namespace fleetmap::eval {
namespace {

constexpr double kFarthestCube = 1e6;  ///< cubes from the origin, per axis: keys hold 21 bits of each

}  // namespace

struct ObservedPlaces::Cubes {
  struct Cube {
    std::vector<std::uint32_t> points;  ///< of each robot
    std::size_t robots = 0;             ///< that saw it
  };
  double edge;
  std::uint32_t min_points;
  std::unordered_map<std::uint64_t, Cube> cubes;

  bool key_of(const Eigen::Vector3f& point, std::uint64_t& key) const {
    const Eigen::Vector3d at = (point.cast<double>() / edge).array().floor();
    if (!at.allFinite() || at.cwiseAbs().maxCoeff() >= kFarthestCube) return false;
    key = 0;
    for (int k = 0; k < 3; ++k) {
      const auto index = static_cast<std::uint64_t>(static_cast<std::int64_t>(at[k] + kFarthestCube));
      key = (key << 21) | index;
    }
    return true;
  }
};

ObservedPlaces::ObservedPlaces(double edge, std::uint32_t min_points)
    : cubes_(std::make_unique<Cubes>(Cubes{edge, min_points, {}})) {}
ObservedPlaces::~ObservedPlaces() = default;
ObservedPlaces::ObservedPlaces(ObservedPlaces&&) noexcept = default;
ObservedPlaces& ObservedPlaces::operator=(ObservedPlaces&&) noexcept = default;

void ObservedPlaces::add(std::size_t robot, const cloud::PointCloud& points) {
  std::uint64_t key = 0;
  for (const Eigen::Vector3f& point : points.points) {
    if (!cubes_->key_of(point, key)) continue;
    Cubes::Cube& cube = cubes_->cubes[key];
    if (cube.points.size() <= robot) cube.points.resize(robot + 1, 0);
    if (++cube.points[robot] == cubes_->min_points) ++cube.robots;
  }
}

std::size_t ObservedPlaces::count(std::size_t robots) const {
  std::size_t count = 0;
  for (const auto& [key, cube] : cubes_->cubes) count += cube.robots >= robots ? 1u : 0u;
  return count;
}

std::vector<std::size_t> ObservedPlaces::indices_within(const cloud::PointCloud& points,
                                                        std::size_t robots) const {
  std::vector<std::size_t> indices;
  std::uint64_t key = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!cubes_->key_of(points.points[i], key)) continue;
    const auto cube = cubes_->cubes.find(key);
    if (cube != cubes_->cubes.end() && cube->second.robots >= robots) indices.push_back(i);
  }
  return indices;
}

cloud::PointCloud ObservedPlaces::within(const cloud::PointCloud& points, std::size_t robots) const {
  return cloud::select(points, indices_within(points, robots));
}

}  // namespace fleetmap::eval
