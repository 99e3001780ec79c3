#include "fleetmap/sim/parked_things.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "counter_random.hpp"
#include "mesh_builder.hpp"

namespace fleetmap::sim {
namespace {

constexpr std::uint64_t kParked = 0xE1;  // stream of chance
constexpr double kApart = 6.0;           // m, from starts and from each other
constexpr double kAside = 1.0;           // m, at most beside the middle of a lane
constexpr double kSlew = 0.2;            // rad, at most from the direction of a lane
constexpr int kTries = 300;              // for one thing
constexpr double kBodyHeight = 0.25;     // m above the ground; wheels and skids reach down to it

struct Kind {
  double length, width, height;  // m
  Material material;
};
constexpr std::array<Kind, 3> kKinds = {Kind{1.2, 1.0, 1.1, Material::kConcrete},  // a loaded pallet
                                        Kind{2.6, 1.5, 1.3, Material::kMetal},     // a trailer
                                        Kind{4.6, 1.9, 1.9, Material::kMetal}};    // a van

struct ParkingPose {
  Eigen::Vector2d at;
  double yaw;
};

/// Random numbers of one thing at its `attempt`-th position.
struct Chance {
  std::uint64_t seed, thing, attempt;
  double operator()(std::uint64_t what) const {
    return uniform_at(seed, kParked + (thing << 8), attempt, what);
  }
};

std::optional<ParkingPose> in_a_lane(const World& world, const Chance& chance) {
  const std::vector<Aisle>& lanes = world.aisles();
  if (lanes.empty()) return std::nullopt;
  const auto index = static_cast<std::size_t>(chance(0) * static_cast<double>(lanes.size()));
  const Eigen::Vector2d along = lanes[index].to - lanes[index].from;
  const Eigen::Vector2d across = Eigen::Vector2d(-along.y(), along.x()).normalized();
  return ParkingPose{
      lanes[index].from + (0.1 + 0.8 * chance(1)) * along + kAside * (2.0 * chance(2) - 1.0) * across,
      std::atan2(along.y(), along.x()) + kSlew * (2.0 * chance(3) - 1.0)};
}

ParkingPose anywhere(const World& world, const Chance& chance) {
  const WorldBounds& bounds = world.bounds();
  const Eigen::Vector2d size = bounds.high - bounds.low;
  return {bounds.low + Eigen::Vector2d(chance(0) * size.x(), chance(1) * size.y()),
          2.0 * std::numbers::pi * chance(2)};
}

bool inside(const Footprint& polygon, const Eigen::Vector2d& p) {
  bool odd = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector2d& a = polygon[k];
    const Eigen::Vector2d& b = polygon[(k + 1) % polygon.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    odd ^= p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  }
  return odd;
}

bool far_from(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& p) {
  for (const Eigen::Vector2d& q : points) {
    if ((p - q).norm() < kApart) return false;
  }
  return true;
}

void add_thing(const Kind& kind, const ParkingPose& pose, const World& world, Mesh& mesh) {
  const Eigen::Vector2d direction(std::cos(pose.yaw), std::sin(pose.yaw));
  MeshBuilder builder(mesh, direction);
  const Eigen::Vector2d uv(direction.dot(pose.at), direction.x() * pose.at.y() - direction.y() * pose.at.x());
  // On the highest ground under it, so that nothing of it is taken for the ground.
  const Eigen::Vector2d across(-direction.y(), direction.x());
  double ground = world.ground_height(pose.at);
  for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    ground = std::max(ground, world.ground_height(pose.at + 0.5 * u * kind.length * direction +
                                                  0.5 * v * kind.width * across));
  }
  const auto box = [&](double length, double width, double bottom, double top) {
    const auto corner = [&](double u, double v) {
      return MeshBuilder::Point(uv.x() + 0.5 * u * length, uv.y() + 0.5 * v * width, ground + bottom);
    };
    builder.slab({corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)},
                 MeshBuilder::Point(0.0, 0.0, top - bottom), kind.material);
  };
  box(0.8 * kind.length, 0.9 * kind.width, 0.02, kBodyHeight);
  box(kind.length, kind.width, kBodyHeight, kind.height);
}

}  // namespace

Result<std::shared_ptr<const World>> with_parked_things(const World& world, std::size_t count,
                                                        std::uint64_t seed,
                                                        std::span<const Eigen::Vector2d> keep_free) {
  std::vector<Eigen::Vector2d> taken(keep_free.begin(), keep_free.end());
  Mesh mesh = world.mesh();
  for (std::uint64_t thing = 0; thing < count; ++thing) {
    bool placed = false;
    for (std::uint64_t attempt = 0; attempt < kTries && !placed; ++attempt) {
      const Chance chance{seed, thing, attempt};
      const Kind& kind = kKinds[static_cast<std::size_t>(chance(4) * kKinds.size())];
      const auto lane = thing % 3 == 2 ? std::nullopt : in_a_lane(world, chance);
      const ParkingPose pose = lane.value_or(anywhere(world, chance));
      const double room = lane ? 0.5 * kind.width : 0.5 * kind.length + 1.5;
      if (!inside(world.drawing().boundary, pose.at) || world.blocked(pose.at, room)) continue;
      if (!far_from(taken, pose.at)) continue;
      add_thing(kind, pose, world, mesh);
      taken.push_back(pose.at);
      placed = true;
    }
    if (!placed) {
      return failure("there is no room for " + std::to_string(count) + " parked things, only for " +
                     std::to_string(thing) + "; take fewer");
    }
  }
  return World::create(std::move(mesh), world.drivable(), world.drawing());
}

}  // namespace fleetmap::sim
