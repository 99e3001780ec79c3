#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/place/descriptor.hpp"

namespace fleetmap::exchange {

struct LookalikeConfig {
  double spacing_m = 8.0;        ///< m along a track between the places that are compared
  double min_similarity = 0.35;  ///< of a pair that may be an encounter, [0, 1]
  double sure_similarity = 0.5;  ///< a pair this much alike needs no other that agrees
  double min_support = 1.0;      ///< else: summed similarity of other places that tell the same relative pose
  double agree_m = 5.0;          ///< m, and
  double agree_rad = 0.25;       ///< rad, within which two pairs tell the same
  std::size_t kept = 5;          ///< pairs of one place that may support others
  std::size_t max_compared = 200;  ///< places of one other agent; those with most alike amounts of things
  Status validate() const;
};

/// Which places of two tracks look alike, for where no GPS tells which are near each other: by descriptor,
/// and by how many of them agree on how the two odometry frames lie. In rows that repeat a single pair is
/// often one row off, several in a row are less often. What it finds is worth a registration, no more.
class Lookalikes {
 public:
  explicit Lookalikes(const LookalikeConfig& config) : config_(config) {}

  struct Pair {
    NodeId fresh;  ///< the node that was added
    NodeId other;
    double similarity = 0.0;
    double support = 0.0;
    double distance = 0.0;  ///< m, between the two, as the descriptors tell
  };
  enum class Side : std::uint8_t { kOurs, kTheirs };
  /// Remembers the node and compares it with the places of the other side. `located`: G is good enough to
  /// find encounters by; two such places are not compared. Returns the best pair with each agent of the other
  /// side that is worth registering.
  std::vector<Pair> add(const graph::Node& node, bool located, Side side);

 private:
  struct Place {
    NodeId id;
    graph::FrameId frame;
    bool located = false;
    Pose T_odom_base = Pose::Identity();
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    place::Descriptor descriptor;
  };
  struct Sighting {
    Pair pair;
    Pose T_ours_theirs = Pose::Identity();             ///< odometry frames
    Eigen::Vector3d theirs = Eigen::Vector3d::Zero();  ///< the node, in its odometry frame
  };
  using FramePair = std::pair<graph::FrameId, graph::FrameId>;  ///< ours, theirs

  using Track = std::pair<Side, AgentId>;

  std::vector<const Place*> candidates(const Place& fresh, const Track& other) const;
  std::vector<std::pair<FramePair, Sighting>> compare(const Place& fresh, const Track& other) const;
  double support_of(const FramePair& frames, const Sighting& sighting) const;

  LookalikeConfig config_;
  std::map<Track, std::vector<Place>> places_;
  std::map<FramePair, std::vector<Sighting>> sightings_;
};

}  // namespace fleetmap::exchange
