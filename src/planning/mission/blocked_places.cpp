#include "mission/blocked_places.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kAhead = 2.0;       // m from the stuck robot to the obstacle
constexpr double kLifetime = 300.0;  // s, after which a blocked place is tried again
constexpr double kBeside = 0.2;      // m around a blockage within which it would touch the robot

}  // namespace

void BlockedPlaces::remove_oldest() {
  places_.erase(places_.begin());
  added_.erase(added_.begin());
}

void BlockedPlaces::add(const Polyline& path, double progress, const Eigen::Vector2d& position, Stamp now) {
  double along = progress + kAhead;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const Eigen::Vector2d d = path[k] - path[k - 1];
    if (along > d.norm() && k + 1 < path.size()) {
      along -= d.norm();
      continue;
    }
    const Eigen::Vector2d toward =
        d.norm() > 0.0 ? Eigen::Vector2d(d.normalized()) : Eigen::Vector2d(1.0, 0.0);
    const Blockage blockage{path[k - 1] + along * toward};
    if ((blockage.centre - position).norm() < blockage.radius + kBeside) return;
    if (places_.size() == kMaxPlaces) remove_oldest();
    places_.push_back(blockage);
    added_.push_back(now);
    return;
  }
}

Result<Polyline> BlockedPlaces::route(const RoutePlanner& planner, const Eigen::Vector2d& from,
                                      const Eigen::Vector2d& to, Stamp now) {
  while (!added_.empty() && now - added_.front() > from_seconds(kLifetime)) remove_oldest();
  auto way = planner.route(from, to, places_);
  return way || places_.empty() ? way : planner.route(from, to);
}

}  // namespace fleetmap::planning
