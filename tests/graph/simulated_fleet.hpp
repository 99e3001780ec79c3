#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph::testing {

inline constexpr double kPitch = 6.0;  ///< m between the lanes of the farm
inline constexpr double kDegree = 0.017453292519943295;

struct SimulatedFleetConfig {
  int robots = 3;
  int lanes = 4;                       ///< of each robot
  bool interleaved = false;            ///< lane by lane in turn, instead of each robot's side by side
  double length = 60.0;                ///< m of a lane
  double spacing = 4.0;                ///< m between nodes
  double speed = 1.0;                  ///< m/s
  double gps_sigma = 1.5;              ///< m an axis, nine tenths of its variance drift
  double gps_correlation_time = 60.0;  ///< s
  double yaw_sigma = 1.0 * kDegree;
  double tilt_sigma = 0.3 * kDegree;
  /// G is that of an EKF, which reckons where there are no fixes: not from `lost_from` to `lost_until`, s.
  bool filtered = false;
  double lost_from = 0.0, lost_until = 0.0;
  double reckoning = 0.12;                ///< m a root of a second, of the filter without fixes
  double odometry_share = 0.002;          ///< m a metre
  double odometry_turn = 0.05 * kDegree;  ///< rad a metre
  double alignment_sigma = 0.03;          ///< m
  double alignment_turn = 0.002;          ///< rad
  double reach = 14.0;                    ///< m, nodes of two robots this near are registered
  int every = 3;                          ///< own nodes between registrations with one other robot
};

/// Configuration of a long mission on interleaved lanes: each robot's nodes, and no alignments yet.
SimulatedFleetConfig long_mission(int robots, int nodes_each);

class SimulatedFilter;

/// Robots on the lanes of a solar farm, whose odometry, GPS and registrations err as their covariances say.
class SimulatedFleet {
 public:
  explicit SimulatedFleet(unsigned seed, const SimulatedFleetConfig& config = {});

  static AgentId agent(int r);

  LocalFrame site{geo_point_from_degrees(39.0, -3.0, 600.0)};
  std::vector<Node> nodes;
  std::vector<Alignment> alignments;
  std::map<NodeId, Pose> truth;  ///< T_enu_node

  double gauss(double sigma);
  std::mt19937& random() { return random_; }

  const Node& node(const NodeId& id) const;
  Matrix6d alignment_covariance() const;

  /// A registration that saw node j at T_enu_j.
  AlignmentMode observed_at(const NodeId& i, const Pose& T_enu_j);

  Alignment& align(const NodeId& i, const NodeId& j, const AgentId& by,
                   const Eigen::Vector3d& shift = Eigen::Vector3d::Zero());

  /// Aligns neighbours on interleaved lanes at every `every`-th node; a `share` of that is false: a third of
  /// these one row off, the others metres off anywhere. Returns the names of the false ones.
  std::set<std::pair<AgentId, std::uint32_t>> align_neighbours(int every, double share);

  /// Pairs of nodes of two robots that are near each other, spread over the mission.
  std::vector<std::pair<NodeId, NodeId>> near_pairs(const AgentId& a, const AgentId& b, int every) const;

  /// From node `first` on, the robot was carried away and its program started anew.
  void kidnap(const AgentId& robot, std::uint32_t first);

 private:
  Pose on_lanes(int robot, double s) const;
  void drive(const AgentId& robot, int r);
  /// G of the node as the filter has it, after the way from the one before.
  void reckon(SimulatedFilter& filter, const Pose& before, const Pose& T, double seconds, bool first,
              Node& node);
  void step(const Pose& before, const Pose& T, Pose& T_odom, Node& node);
  void meet();

  SimulatedFleetConfig config_;
  std::mt19937 random_;
  std::map<AgentId, std::uint32_t> next_seq_;
};

}  // namespace fleetmap::graph::testing
