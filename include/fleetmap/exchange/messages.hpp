#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::exchange {

// ---- long range
// -----------------------------------------------------------------------------------------------

/// Answer of Alg. 2: `from` found its own `ours` within `radius` of the node `theirs` of `to`.
struct ProximityMatch {
  AgentId from;
  AgentId to;
  NodeId theirs;
  NodeId ours;
  double distance = 0.0;  ///< m, haversine
  double radius = 0.0;    ///< m, r^i of Eq. 1
};

/// A piece of one encoded spherized cloud, small enough for one UDP datagram.
struct CloudFragment {
  static constexpr std::size_t kMaxPayload = 1100;
  AgentId from;
  AgentId to;
  NodeId node;               ///< the cloud is centred on this node of `from`
  ContentHash cloud_hash{};  ///< of the whole encoded cloud
  std::uint32_t total_bytes = 0;
  std::uint16_t index = 0;  ///< this piece starts at index * kMaxPayload
  std::uint16_t count = 0;
  Bytes payload;
};

/// `from` asks `to` for pieces of a cloud; no index means the whole.
struct CloudRequest {
  static constexpr std::size_t kMaxMissing = 256;
  AgentId from;
  AgentId to;
  NodeId node;
  std::vector<std::uint16_t> missing;
  float information = 0.0f;  ///< nats, of the alignment that `from` hopes for (graph::InformationGain)
};

using Range = SeqRange;

/// What `from` holds. Sent from time to time, so that whoever lacks something asks for it. Each range has a
/// fingerprint of its contents (store::Store::node_print), so that two robots that hold other contents under
/// the same names find that out; a range may be cut to say where (ContentCheck).
struct Digest {
  AgentId from;
  std::vector<Range> nodes;
  std::vector<Range> alignments;
  std::vector<std::uint32_t> node_prints = {};  ///< of each range of `nodes`
  std::vector<std::uint32_t> alignment_prints = {};
};

/// `from` asks `to` for items that the digest of `to` offered.
struct ItemRequest {
  AgentId from;
  AgentId to;
  std::vector<Range> nodes;
  std::vector<Range> alignments;
};

/// A part of its share of the radio's budget that a robot leaves to another one (budget_shares.hpp).
struct Loan {
  AgentId borrower;
  std::uint16_t bytes_per_second = 0;
  bool operator==(const Loan&) const = default;
};

/// How `from` is doing, for people, for planning and for dividing the radio's budget.
struct AgentStatus {
  AgentId from;
  Stamp stamp;
  GeoPoint position;
  float heading = 0.0f;             ///< rad, counter-clockwise from east
  float position_stddev = 0.0f;     ///< m, horizontal
  float battery = -1.0f;            ///< [0, 1], negative when unknown
  std::uint32_t nodes = 0;          ///< held, all agents
  std::uint32_t alignments = 0;     ///< held, all agents
  std::uint32_t submaps = 0;        ///< held, all agents
  std::uint32_t backlog_bytes = 0;  ///< waiting for the long-range link
  bool busy = false;                ///< more nodes or alignments of `from` may come
  std::vector<Loan> loans = {};
};

/// What `from` does of the fleet's mission: planning::MissionReport as it goes to the others. Rows are
/// counted in the mission's order; sets of rows have row k as bit k % 8 of byte k / 8.
struct MissionReport {
  AgentId from;
  Stamp stamp;
  std::uint8_t state = 0;     ///< planning::MissionState
  float east = 0.0f;          ///< m, ENU of the site
  float north = 0.0f;         ///< m
  float battery = 1.0f;       ///< share left, [0, 1]
  std::uint32_t current = 0;  ///< row under way; 2^32 - 1: none
  Bytes done;                 ///< rows driven by anyone, as far as `from` knows
  Bytes claimed;              ///< rows that `from` is going to drive
  Bytes failed;               ///< rows that `from` gave up
};

/// An operator's order to stand still or to drive on. Of the orders that concern a robot, for itself or for
/// all, the one with the latest stamp is in force.
struct HoldOrder {
  Stamp stamp;    ///< when it was given; raised above that of the order which it replaces, whatever the clock
  AgentId robot;  ///< empty: every robot
  AgentId issuer;  ///< for people
  bool hold = false;
  bool operator==(const HoldOrder&) const = default;
};

/// Orders that `from` gives (an operator, a button) or repeats (an agent, so that nobody misses them).
struct Hold {
  enum class Driving : std::uint8_t {
    kNoRobot,    ///< `from` is an operator
    kFree,       ///< `from` drives its mission
    kHeld,       ///< `from` stands by an order
    kNoMission,  ///< `from` obeys nobody here: something else drives it
  };
  AgentId from;
  Driving driving = Driving::kNoRobot;
  std::vector<HoldOrder> orders;
};

// ---- short range
// ----------------------------------------------------------------------------------------------

/// Which submaps `from` holds whole, and whom it hears on this link.
struct SubmapDigest {
  AgentId from;
  std::vector<Range> submaps;
  std::vector<AgentId> hears;
};

/// `from` asks `to` for bytes [offset, offset + length) of an encoded submap.
struct SubmapRequest {
  AgentId from;
  AgentId to;
  NodeId node;
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
};

struct SubmapChunk {
  static constexpr std::size_t kMaxPayload = 8192;
  AgentId from;
  AgentId to;
  NodeId node;
  std::uint32_t offset = 0;
  std::uint32_t total_bytes = 0;
  Bytes payload;
};

using Message =
    std::variant<graph::Node, ProximityMatch, CloudFragment, CloudRequest, graph::Alignment, Digest,
                 ItemRequest, AgentStatus, MissionReport, Hold, SubmapDigest, SubmapRequest, SubmapChunk>;

}  // namespace fleetmap::exchange
