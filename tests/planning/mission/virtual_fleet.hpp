#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "fleetmap/planning/mission/mission_executive.hpp"
#include "fleetmap/planning/mission/row_coverage.hpp"
#include "planning/mission/map_radio.hpp"

namespace fleetmap::planning::testing {

inline constexpr double kLoss = 0.3;      ///< share of the reports that get lost
inline constexpr double kLimit = 6000.0;  ///< s

/// Executives on robots that drive their paths exactly, with reports that get lost. One step is a second.
class VirtualFleet {
 public:
  struct Robot {
    std::unique_ptr<MissionExecutive> executive;  ///< none: killed, or not yet started
    Pose2 pose;
    double speed = 1.5;
    double battery = 1.0;
    double drain = 0.0;  ///< share a second
    MissionAction action;
    double along = 0.0;     ///< m of action.path
    double standing = 0.0;  ///< s without getting on
    bool exchanged = false;
    bool called_home = false;
    double driven = 0.0;  ///< m
    MissionState state = MissionState::kDriving;
  };
  struct Obstacle {
    Eigen::Vector2d at;
    double radius;
  };

  VirtualFleet(std::shared_ptr<const FleetPlan> shared, double loss, std::uint64_t seed);
  void start(std::size_t k);
  /// Every robot that lives hears the order.
  void give(RowId row, std::size_t from, std::optional<std::size_t> to);
  void kill(std::size_t k) { robots[k].executive.reset(); }

  std::shared_ptr<const FleetPlan> plan;
  std::vector<Robot> robots;
  std::vector<Obstacle> obstacles;
  std::function<bool(std::size_t, double)> silent = [](std::size_t, double) { return false; };
  /// Without it, all maps are exchanged as soon as all wait at the meeting.
  std::optional<MapRadio> radio;
  double now = 0.0;

  Stamp stamp() const;

  void step();
  /// s until all living robots are done, or `limit`.
  double run(
      double limit, const std::function<void()>& each = [] {});
  /// Rows whose every metre some robot drove.
  std::size_t rows_driven() const;
  /// m of the row that robot `k` drove.
  double driven_by(std::size_t k, RowId row) const;

 private:
  void move(Robot& robot);
  static Eigen::Vector2d point(const Polyline& path, double along);
  void mark(const Robot& robot);
  void report();
  /// Maps flow when all who are alive and can move wait at the meeting.
  void exchange();
  void exchange_by_radio();

  double loss_;
  std::mt19937_64 random_;
  std::map<RowId, std::set<int>> visited_;
  std::map<std::pair<std::size_t, RowId>, std::set<int>> visited_by_;
  std::vector<messages::RowOrder> orders_;
  RowCoverage coverage_;  ///< by the nodes of all, which every robot gets
};

}  // namespace fleetmap::planning::testing
