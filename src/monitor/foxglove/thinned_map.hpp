#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/monitor/fleet_view.hpp"
#include "point_levels.hpp"

namespace fleetmap::monitor::foxglove {

/// The points of all placed submaps in ENU, at most so many: of each submap a prefix of its points from
/// coarse to fine. The points are shared equally; what a small submap leaves over goes to the later ones.
///
/// It is built in steps that load one submap each. The prefixes are kept, so that a view with more nodes or
/// other poses loads the new submaps alone. Memory is at most twice the points.
class ThinnedMap {
 public:
  using Cloud = std::shared_ptr<const QuantisedCloud>;
  /// The submap of a node, in the node's frame.
  using Load = std::function<Result<Cloud>(const graph::Node& node)>;
  ThinnedMap(std::size_t max_points, Load load) : max_points_(max_points), load_(std::move(load)) {}

  /// Starts over with the submaps of `view`.
  void begin(std::shared_ptr<const FleetView> view);
  /// Loads at most one submap. True if there are more.
  bool step();
  /// foxglove::PointCloud of what was loaded: x, y, z (float32, m), intensity (uint16, 0 to 32767 of the
  /// strongest in the submap), robot (uint16, its place among robots_of()).
  Bytes message() const;
  /// Submaps of the view that could not be loaded; they are missing from the map.
  const std::vector<NodeId>& unreadable() const { return unreadable_; }

  static constexpr std::size_t kPointBytes = 16;

 private:
  struct Part {
    const graph::Node* node = nullptr;  ///< of `view_`
    Eigen::Affine3f T_enu_node = Eigen::Affine3f::Identity();
    std::uint16_t robot = 0;
    std::size_t points = 0;  ///< that the map has of it
  };
  bool holds(const NodeId& id, std::size_t points) const;
  void append(const Part& part, Bytes& points) const;

  std::size_t max_points_;
  Load load_;
  std::shared_ptr<const FleetView> view_;
  std::vector<Part> parts_;
  std::size_t next_ = 0;                   ///< of parts_
  std::size_t left_ = 0;                   ///< points
  std::map<NodeId, QuantisedCloud> kept_;  ///< prefixes
  std::vector<NodeId> unreadable_;
};

}  // namespace fleetmap::monitor::foxglove
