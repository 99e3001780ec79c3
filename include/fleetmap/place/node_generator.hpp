#pragma once

#include <cstdint>
#include <optional>

#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/place/node_generator_config.hpp"

namespace fleetmap::place {

/// Alg. 1 of the paper: the first pose makes a node, and then each pose that lies farther than D_thresh from
/// the last node's O. (The paper prints the comparison the wrong way round.)
class NodeGenerator {
 public:
  /// `config` must be valid.
  explicit NodeGenerator(const NodeGeneratorConfig& config) : config_(config) {}

  /// True if a node is due at O = `T_odom_base`, which then counts as the last node's. A pose that is not
  /// finite is never a node and is counted.
  bool offer(const Pose& T_odom_base);
  /// Goes on from a node made earlier, e.g. one read back from the store.
  void resume_from(const Pose& T_odom_base) { last_ = T_odom_base.translation(); }

  std::uint64_t refused() const { return refused_; }

 private:
  NodeGeneratorConfig config_;
  std::optional<Eigen::Vector3d> last_;
  std::uint64_t refused_ = 0;
};

}  // namespace fleetmap::place
