#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fleetmap/exchange/encounters.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/registration/register_clouds.hpp"

namespace fleetmap::agent {

/// Finds which places of this session are places of an earlier one, since nobody knows how the robot moved in
/// between: by G where both have one that tells (EncounterConfig::max_sigma_m), else by what they look like.
/// All nodes are the robot's own.
class SessionTies {
 public:
  struct Tie {
    const graph::Node* earlier;
    registration::Prior prior;  ///< of T_earlier_later
  };

  explicit SessionTies(const exchange::EncounterConfig& config) : config_(config) {}

  /// A session begins after those that the nodes of `earlier` are of; these must stay where they are.
  void begin(const std::vector<const graph::Node*>& earlier);
  /// One more of an earlier session, which others gave back after our store was lost.
  void add_earlier(const graph::Node& node);
  /// Nodes of this session, in their order. What is worth a registration, at most one a node.
  std::optional<Tie> on_own_node(const graph::Node& node);
  /// The registration of a node of this session with `earlier` was accepted.
  void on_accepted(const graph::Node& earlier, const graph::Node& later);

 private:
  struct Session {
    std::vector<const graph::Node*> nodes;
    std::optional<exchange::Lookalikes> lookalikes;  ///< made once one is needed
    int by_place = 0, by_looks = 0;                  ///< ties that were accepted
  };
  bool located(const graph::Node& node) const;
  const graph::Node* nearest(const graph::Node& node) const;
  const graph::Node* most_alike(const graph::Node& node);

  exchange::EncounterConfig config_;
  std::map<std::uint16_t, Session> earlier_;
};

}  // namespace fleetmap::agent
