#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::agent {

struct LoopClosureConfig {
  /// m between two nodes, as the odometry sees them, to share surroundings. What lies 45 m apart shares the
  /// middle: a robot that drives every sixth row of a large site has no other tie between its lanes.
  double reach = 45.0;
  /// m driven between them: what is nearer on the path has drifted too little. Twice the radius of spherized
  /// clouds at least, so that the two share nothing that was seen.
  double min_path = 90.0;
  double spacing = 20.0;  ///< m driven since the last closure
  /// A node is used when so many more were made: its surroundings are then seen from both sides.
  std::uint32_t ripe_nodes = 3;
  Status validate() const;
};

/// Two own nodes of one odometry frame that lie near each other though much was driven between them.
struct LoopClosure {
  graph::Node earlier;
  graph::Node later;
  Matrix6d covariance;  ///< of the odometry from the one to the other, right tangent: [m, rad]
};

/// Finds where a robot comes back to its own path, for the fleet graph: rows that lie side by side are driven
/// minutes apart. Only odometry is used, so it needs no GPS.
class LoopClosures {
 public:
  explicit LoopClosures(const LoopClosureConfig& config) : config_(config) {}

  /// Own nodes in their order. At most one closure a node: that with the nearest earlier one.
  std::optional<LoopClosure> on_own_node(const graph::Node& node);

 private:
  std::optional<std::size_t> nearest_earlier(std::size_t later) const;
  Matrix6d covariance_between(std::size_t earlier, std::size_t later) const;

  LoopClosureConfig config_;
  std::vector<graph::Node> nodes_;  ///< of the current frame
  std::vector<double> path_;        ///< m driven until each of them
  std::optional<double> last_closure_;
};

}  // namespace fleetmap::agent
