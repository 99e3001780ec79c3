#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/routes/route_planner_config.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Ground that turned out to be blocked while driving.
struct Blockage {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< ENU, m
  double radius = 1.4;                               ///< m
};

/// Shortest drivable paths on a site: a visibility graph over the corners of its keep-outs, held off by the
/// clearance. Exact (to the raster) for up to some thousand corners; on sites with more, corners that lie far
/// apart are joined over a lattice and paths are straightened, so they may be some percent longer than the
/// shortest. Immutable; const members from any thread.
class RoutePlanner {
 public:
  /// A point joined to the graph: made once, used for many routes.
  struct Anchor {
    Eigen::Vector2d point = Eigen::Vector2d::Zero();      ///< as asked for
    Eigen::Vector2d free = Eigen::Vector2d::Zero();       ///< where it joins the clear ground
    bool valid = false;                                   ///< false: no clear ground within `snap`
    std::vector<std::pair<std::uint32_t, double>> links;  ///< vertex, m
  };
  /// Length and turns of the path from one anchor to another.
  struct Leg {
    double length = std::numeric_limits<double>::infinity();  ///< m; infinite: no way
    double turn = 0.0;           ///< rad turned between the first and the last piece
    double first_heading = 0.0;  ///< rad, of the first piece
    double last_heading = 0.0;   ///< rad, of the last piece
  };

  /// `also`: points of interest outside of rows and keep-outs, such as where the robots start.
  static Result<RoutePlanner> create(const Mission& mission, const RoutePlannerConfig& config = {},
                                     std::span<const Eigen::Vector2d> also = {});

  /// From `from` to `to`, both included. Fails, with the remedy, if there is no way or an end stands in a
  /// keep-out farther than `snap` from clear ground.
  /// Paths that touch one of `blocked` are not taken.
  Result<Polyline> route(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                         std::span<const Blockage> blocked = {}) const;
  /// A row as it is driven: straight between its waypoints as the mission wants it, around keep-outs that
  /// stand on it.
  Result<Polyline> along(const Row& row, bool reversed) const;

  Anchor anchor(const Eigen::Vector2d& p) const;
  Leg leg(const Anchor& from, const Anchor& to) const;
  /// One search for all targets.
  std::vector<Leg> legs(const Anchor& from, std::span<const Anchor> to) const;
  /// m from `from` to each of vertices().
  std::vector<double> distances(const Anchor& from) const;
  const std::vector<Eigen::Vector2d>& vertices() const;

  bool clear(const Eigen::Vector2d& p) const;
  /// The straight line keeps the clearance.
  bool clear(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  const RoutePlannerConfig& config() const;

 private:
  struct State;
  struct Search;
  explicit RoutePlanner(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  Search search(const Anchor& from, std::span<const Blockage> blocked = {}) const;
  Polyline unwind(const Search& search, const Anchor& from, const Anchor& to,
                  std::span<const Blockage> blocked = {}) const;
  std::shared_ptr<const State> state_;
};

}  // namespace fleetmap::planning
