#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/lookalikes.hpp"
#include "fleetmap/exchange/messages.hpp"
#include "fleetmap/graph/alignment_worth.hpp"
#include "fleetmap/graph/frame_ties.hpp"
#include "fleetmap/place/ball_tree.hpp"
#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::exchange {

/// Which encounter's clouds are asked for first.
enum class EncounterOrder : std::uint8_t {
  kWorth,      ///< whose alignment would teach the fleet's graph most
  kFirstCome,  ///< which was found first
};
const char* to_string(EncounterOrder order);

struct EncounterConfig {
  place::ProximityConfig proximity;  ///< r^i of Eq. 1
  double max_sigma_m = 15.0;  ///< m, horizontal, of a G by which encounters are found; beyond it, and without
                              ///< G, places are known again by what they look like
  LookalikeConfig lookalikes;
  double spacing_m = 10.0;          ///< m between encounters of the same two agents
  double spacing_aligned_m = 20.0;  ///< m, the same once the two have a good alignment (E_ij <= 0.4)
  double spacing_failed_m =
      5.0;  ///< m from an encounter whose registration was rejected or whose cloud got lost
  /// A cloud of a few scans tilts and turns, and a nearer pair may come up: the clouds of a pair are asked
  /// for when both robots have made so many nodes more ...
  std::uint32_t ripe_nodes = 3;
  Duration ripe_after = std::chrono::seconds(20);  ///< ... or this long after the pair was found
  Duration retry_after =
      std::chrono::seconds(60);  ///< s until a failed pair is tried again, with fuller clouds
  int max_attempts = 2;          ///< of one pair of nodes
  EncounterOrder order = EncounterOrder::kWorth;
  /// nats; an encounter that is worth less when it could be asked for is let go, unless the radio has room.
  double min_worth = 0.4;
  std::size_t max_active = 2;                        ///< clouds asked for and not yet registered
  std::size_t max_waiting = 256;                     ///< encounters found and not begun; the oldest gives way
  Duration peer_timeout = std::chrono::seconds(60);  ///< s, an agent not heard for so long is not asked
  int match_repeats = 3;  ///< a match is sent so often unless the peer shows that it knows
  Duration match_period = std::chrono::seconds(3);  ///< s
  bool stop_when_peer_aligned =
      true;  ///< a good alignment of the same two nodes by the peer ends our own attempt
  Status validate() const;
};

/// Our node and the peer's. Both ends find the same pair from the same nodes.
struct NodePair {
  NodeId ours;
  NodeId theirs;
  auto operator<=>(const NodePair&) const = default;
};

struct EncounterStats {
  std::uint64_t found = 0;      ///< pairs within r^i
  std::uint64_t alike = 0;      ///< pairs of places that look alike, where GPS does not tell
  std::uint64_t tied = 0;       ///< pairs within r^i by alignments found before, where GPS does not tell
  std::uint64_t redundant = 0;  ///< of these, too near to another encounter to be worth its bytes
  std::uint64_t begun = 0;      ///< clouds asked for
  std::uint64_t accepted = 0;
  std::uint64_t rejected = 0;
  std::uint64_t lost = 0;  ///< the cloud never came
  std::uint64_t settled_by_peer =
      0;                          ///< begun, and ended by the peer's good alignment before the cloud was here
  std::uint64_t yielded = 0;      ///< begun, and given up for the pair that the peer had chosen
  std::uint64_t crowded_out = 0;  ///< gave way when too many waited
  std::uint64_t worthless = 0;    ///< let go while the radio was busy: what is there already tells as much
};

/// Decides which nodes of two agents are worth registering (Alg. 2, and what the paper leaves open: how
/// often).
///
/// A node of a peer arrives: our nearest node within r^i is its partner. A node of our own is made: each
/// peer's nearest node is its partner; the peer, receiving our node, finds the same. Pairs closer than the
/// spacing to one that is under way or done are left out. Should the two ends still begin different pairs at
/// one place (a node was lost on the way), the match messages show it and the smaller pair wins on both
/// sides. Where one of the two has no G that tells where it is, the pair is found by what the places look
/// like (Lookalikes), and the rest goes the same way; once the fleet's graph has tied their odometry frames
/// (graph::FrameTies), by where they lie to each other, as with G.
class Encounters {
 public:
  Encounters(const AgentId& self, const EncounterConfig& config);

  /// A node became known, in any order, also at start from the store.
  void on_node(const graph::Node& node, Stamp now);
  /// The name of a node became contested: it is no partner any more.
  void forget(const NodeId& node);
  /// An alignment became known, whoever computed it.
  void on_alignment(const graph::Alignment& alignment, Stamp now);
  /// What the fleet's graph uses now (graph::Placement::used).
  void on_used_alignments(std::span<const graph::Alignment> used);
  void on_match(const ProximityMatch& match, Stamp now);
  /// Any message came from `peer`.
  void on_heard(const AgentId& peer, Stamp now);
  /// `peer` asked for the cloud of our node: it knows of the encounter.
  void on_cloud_request(const AgentId& peer, const NodeId& ours);
  /// The cloud of `theirs` came: the pairs to register now.
  std::vector<NodePair> on_cloud(const NodeId& theirs);
  void on_cloud_lost(const NodeId& theirs, Stamp now);
  /// Our registration of the pair was turned down. (An accepted one shows as on_alignment.)
  void on_rejected(const NodePair& pair, Stamp now);

  struct Due {
    std::vector<ProximityMatch> matches;
    struct Wanted {
      NodeId node;
      double worth = 0.0;  ///< nats
    };
    std::vector<Wanted> wanted;       ///< clouds to ask for
    std::vector<NodePair> withdrawn;  ///< no longer worth the bytes of either cloud
  };
  /// `radio_has_room`: clouds of little worth delay nothing.
  Due tick(Stamp now, bool radio_has_room = false);

  /// An encounter waits for the cloud of `theirs`.
  bool wants(const NodeId& theirs) const;
  /// T_ours_theirs by alignments found before; none where G tells, where nothing ties the two frames, and
  /// where what was found this way has failed again and again.
  std::optional<UncertainPose> tied(const NodePair& pair) const;
  /// Nothing is under way or about to be, but for what is with the agents in `without`.
  bool idle(Stamp now, const std::set<AgentId>& without = {}) const;
  bool has_good_alignment(const AgentId& peer) const { return aligned_.contains(peer); }
  const EncounterStats& stats() const { return stats_; }

 private:
  enum class Phase : std::uint8_t { kWaiting, kAsked, kRegistering, kDone, kFailed };
  struct Encounter {
    Phase phase = Phase::kWaiting;
    Stamp found;
    Stamp retry_at;  ///< of one that failed
    int attempts = 0;
    double distance = 0.0;           ///< m
    double radius = 0.0;             ///< m
    std::optional<double> likeness;  ///< of one found by what the places look like: similarity + support
    bool by_tie = false;             ///< found, or registered, by what ties the two frames
    int matches_sent = 0;
    Stamp next_match;
    bool known_to_peer = false;
  };
  struct Track {
    place::BallTree tree;
    std::vector<NodeId> ids;                        ///< by index in the tree
    std::map<std::uint16_t, std::uint32_t> newest;  ///< of each session
  };
  /// Where a node is, as far as redundant encounters are concerned.
  struct Spot {
    std::optional<GeoPoint> position;
    graph::FrameId frame;
    Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();
  };
  struct TiedFrames {
    Pose T_ours_theirs = Pose::Identity();  ///< odometry frames
    bool searched = false;                  ///< or being searched: also the nodes of before
  };
  bool located(const graph::Node& node) const;
  /// The two lie within `limit` (m) of each other; false where nobody can tell.
  static bool near(const Spot& a, const Spot& b, double limit);
  void find(const graph::Node& node, const AgentId& other, Stamp now);
  void find_alike(const graph::Node& node, Stamp now);
  /// Of whom a node of `agent` may find its partner: all others if it is ours, else us.
  std::vector<AgentId> partners_of(const AgentId& agent) const;
  void find_tied(const NodeId& node, const AgentId& other, Stamp now);
  /// Alignments found before say how the two lie, if they tie their frames, and are believed.
  bool goes_by_ties(const NodePair& pair) const;
  /// Both nodes are at hand, and G does not tell where both are.
  bool between_unlocated(const NodePair& pair) const;
  /// What was found by ties was turned down.
  void doubt(const AgentId& peer);
  bool doubted(const AgentId& peer) const;
  /// Partners of all nodes of two frames (ours, theirs), some nodes a tick.
  void search_anew(const graph::FrameTies::FramePair& frames);
  /// Of the nodes made after `node` that came before it: odometry may reach them now.
  void search_later(const NodeId& node);
  void search_waiting(Stamp now);
  /// Encounters that may wait besides those that do.
  std::size_t room() const;
  /// A pair within `radius` (m); how it was found does not matter from here on.
  void offer(const NodePair& pair, double distance, double radius, Stamp now);
  /// While nothing has been asked for, a pair that is more alike takes over at the same place.
  void replace_less_alike(const NodePair& pair, double likeness);
  /// While nothing has been asked for, a nearer pair at the same place takes over, and the waiting time with
  /// it.
  Stamp replace_farther(const NodePair& pair, double distance, Stamp now);
  void begin(const NodePair& pair, double distance, double radius, Stamp now, bool known_to_peer);
  /// Encounters with the same agent that are nearer to `pair` than the spacing, `most` of them.
  std::vector<NodePair> too_near(const NodePair& pair, std::size_t most) const;
  /// Another encounter makes this one redundant.
  bool redundant(const NodePair& pair) const { return !too_near(pair, 1).empty(); }
  double spacing(const Encounter& other, const AgentId& peer) const;
  std::vector<NodePair> rivals(const NodePair& pair) const;
  void fail(Encounter& encounter, Stamp now);
  void crowd_out();
  void ask(Due& due, Stamp now, bool radio_has_room);
  /// Those that may be asked for now; which others have made redundant since they were found are let go.
  std::vector<NodePair> ready(Stamp now);
  /// Takes the next to ask for out of `ready`, in the order of the configuration.
  struct Choice {
    NodePair pair;
    double worth = 0.0;
  };
  std::optional<Choice> choose(std::vector<NodePair>& ready, bool radio_has_room);
  void announce(Due& due, Stamp now);
  bool retryable(const NodePair& pair, const Encounter& encounter) const;
  bool heard(const AgentId& peer, Stamp now) const;
  bool ripe(const NodePair& pair, const Encounter& encounter, Stamp now) const;
  std::uint32_t nodes_since(const NodeId& id) const;

  AgentId self_;
  EncounterConfig config_;
  std::map<AgentId, Track> tracks_;
  Lookalikes lookalikes_;
  std::map<NodeId, Spot> places_;
  std::map<NodePair, Encounter> encounters_;
  graph::FrameTies ties_;
  graph::AlignmentWorth worth_;
  std::map<graph::FrameTies::FramePair, TiedFrames> tied_;  ///< ours, theirs
  std::map<AgentId, int> tied_failures_;                    ///< since the last that was accepted
  std::size_t unlocated_ = 0;                               ///< nodes
  std::set<std::pair<NodeId, AgentId>> to_search_;  ///< by ties: a node, and of whom its partner would be
  std::set<AgentId> aligned_;
  std::map<AgentId, Stamp> heard_;
  std::vector<NodePair> withdrawn_;
  EncounterStats stats_;
};

}  // namespace fleetmap::exchange
