#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "fleetmap/agent/gravity_filter.hpp"
#include "fleetmap/agent/perception.hpp"
#include "fleetmap/agent/recent_surroundings.hpp"
#include "fleetmap/agent/submap_builder.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/odometry/motion_covariance.hpp"
#include "fleetmap/place/node_generator.hpp"

namespace fleetmap::agent {

/// Makes the nodes of one robot (Alg. 1): gathers scans of one odometry frame and freezes them every
/// D_thresh. It does not store them.
class NodeFactory {
 public:
  /// The configurations must be valid.
  NodeFactory(const AgentId& self, const SubmapConfig& submap, const place::NodeGeneratorConfig& nodes);

  /// Discards the points since the last node.
  void drop_rest();
  /// A new odometry frame has begun: nothing of the last one is left.
  void begin_frame();
  /// The next scan, heard at `now`. True if a node is due at it. A scan that the odometry lost enters no
  /// node. For 10 s after the first scan no node is due without a global pose, since GPS may take a while to
  /// begin.
  bool add(ScanEstimate&& estimate, Stamp now);
  /// Points were seen since the last node.
  bool has_rest() const { return submap_.points() > 0; }

  struct Made {
    graph::Node node;  ///< as every receiver will hold it (fleet_codec::quantised)
    Bytes submap;      ///< encoded
    std::size_t points = 0;
  };
  /// The node at the last scan, under the name `id`; fails if there is none. Its points are kept until
  /// restart(), so that the next node contains them if this one cannot be stored.
  Result<Made> make(const NodeId& id);
  /// The node that was made is stored: the next one begins at it.
  void restart();

 private:
  bool waits_for_gps(Stamp now);

  AgentId self_;
  place::NodeGeneratorConfig nodes_;
  SubmapBuilder submap_;
  RecentSurroundings recent_surroundings_;
  place::NodeGenerator node_generator_;
  GravityFilter level_;
  odometry::MotionCovariance motion_;           ///< since the last node
  std::optional<ScanEstimate> last_;            ///< of this frame, not lost; without its points
  std::optional<Stamp> waiting_for_gps_until_;  ///< for the first global pose
  bool missing_gps_logged_ = false;
};

}  // namespace fleetmap::agent
