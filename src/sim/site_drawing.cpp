#include "fleetmap/sim/site_drawing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "counter_random.hpp"

namespace fleetmap::sim {
namespace {

constexpr std::uint64_t kWhole = 0xD1, kLane = 0xD2, kFootprint = 0xD3;  // separate streams of chance
constexpr double kTurnShare = 0.3;  // of the error, at the farthest corner
constexpr double kOwnShare = 0.2;   // of the error, of one lane or footprint

/// The error that all of the drawing has in common.
class RigidError {
 public:
  RigidError(const SiteDrawing& drawing, double error, std::uint64_t seed) {
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e12), high = -low;
    const auto include = [&](const Eigen::Vector2d& p) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    };
    for (const Aisle& lane : drawing.lanes) include(lane.from), include(lane.to);
    for (const Eigen::Vector2d& p : drawing.boundary) include(p);
    if (!(low.array() <= high.array()).all()) return;
    middle_ = 0.5 * (low + high);
    const double reach = std::max(1.0, 0.5 * (high - low).norm());
    const double sense = uniform_at(seed, kWhole, 1) < 0.5 ? -1.0 : 1.0;
    turn_ = Eigen::Rotation2Dd(sense * kTurnShare * error / reach);
    const double direction = 2.0 * std::numbers::pi * uniform_at(seed, kWhole, 0);
    shift_ = error * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  }
  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
    return middle_ + turn_ * (p - middle_) + shift_;
  }

 private:
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  Eigen::Rotation2Dd turn_{0.0};
  Eigen::Vector2d shift_ = Eigen::Vector2d::Zero();
};

Eigen::Vector2d own_shift(double error, std::uint64_t seed, std::uint64_t stream, std::size_t feature) {
  return kOwnShare * error *
         Eigen::Vector2d(signed_at(seed, stream, feature, 0), signed_at(seed, stream, feature, 1));
}

}  // namespace

SiteDrawing with_position_error(const SiteDrawing& drawing, double error, std::uint64_t seed) {
  const RigidError rigid(drawing, error, seed);
  SiteDrawing off = drawing;
  for (std::size_t k = 0; k < off.lanes.size(); ++k) {
    const Eigen::Vector2d shift = own_shift(error, seed, kLane, k);
    off.lanes[k] = {rigid(off.lanes[k].from) + shift, rigid(off.lanes[k].to) + shift};
  }
  for (std::size_t k = 0; k < off.keep_out.size(); ++k) {
    const Eigen::Vector2d shift = own_shift(error, seed, kFootprint, k);
    for (Eigen::Vector2d& p : off.keep_out[k]) p = rigid(p) + shift;
  }
  for (Eigen::Vector2d& p : off.boundary) p = rigid(p);
  for (Eigen::Vector2d& p : off.marks) p = rigid(p);
  return off;
}

}  // namespace fleetmap::sim
