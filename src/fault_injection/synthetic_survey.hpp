#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "draws.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/candidate_scheduler.hpp"

namespace fleetmap::fault_injection {

/// The items of robots that drive ellipses beside each other, without sensors: nodes with drifting odometry
/// and GPS errors, submaps of a few random points, and registrations with the true relative pose and noise,
/// with two modes, or without result.
class SyntheticSurvey {
 public:
  SyntheticSurvey(std::uint64_t seed, std::size_t robots);

  const LocalFrame& site() const { return site_; }
  /// `time` since the fleet's start.
  Pose T_enu_base(std::size_t robot, Duration time) const;

  /// The robot's odometry begins a new frame where the robot is.
  void begin_frame(std::size_t robot, Duration time);
  struct Made {
    graph::Node node;  ///< as the wire makes it
    Bytes submap;
  };
  /// A node under this name; nothing as long as the robot is near its last one.
  std::optional<Made> node(std::size_t robot, const NodeId& id, Duration time);
  /// The node made last was stored: the next one is farther on.
  void on_stored(std::size_t robot, const NodeId& id, Duration time);

  /// The encoded cloud around a node, as its robot sends it.
  static Bytes cloud_around(const NodeId& id);
  /// T_enu_base of a node that was stored; null for others.
  const Pose* T_enu_node(const NodeId& id) const;
  /// The alignment by the pair's first robot; empty when it is rejected.
  std::optional<graph::Alignment> registration(const exchange::NodePair& pair, std::uint32_t seq);
  static Result<cloud::PointCloud> decode_submap(ByteView encoded);

 private:
  struct Track {
    double centre_east, centre_north, half_east, half_north;  ///< m
    double start, speed;                                      ///< rad, m/s
    Eigen::Vector3d gps_bias;                                 ///< m
    Pose T_enu_last = Pose::Identity();                       ///< true, at the node before
    Pose T_odom_last = Pose::Identity();
    bool begun = false;  ///< the frame has a node
  };
  Pose odometry_at(const Track& track, const Pose& T_enu_base, const NodeId& id) const;

  std::uint64_t seed_;
  LocalFrame site_;
  std::vector<Track> tracks_;
  std::map<NodeId, Pose> truth_;  ///< T_enu_base
};

}  // namespace fleetmap::fault_injection
