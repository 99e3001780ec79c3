#pragma once

#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::graph {

/// The content of a store with its placement, as a robot last solved it while driving.
struct PlacedFleet {
  GeoPoint origin;  ///< of ENU
  std::vector<Node> nodes;
  std::vector<Alignment> alignments;
  Placement placement;
};

/// An odometry frame of this robot in ENU.
struct PlacedFrame {
  GeoPoint origin;  ///< of ENU
  FrameId frame;
  Pose T_enu_odom = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of the newest own node, axes of ENU: [m, rad]
  bool georeferenced = false;              ///< else ENU is an assumption, and only relative poses hold
};

}  // namespace fleetmap::graph
