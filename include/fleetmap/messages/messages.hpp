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
#include "fleetmap/messages/health.hpp"
#include "fleetmap/messages/mission_report.hpp"

/// Messages between robots. Nodes and alignments (graph) are sent as they are.
namespace fleetmap::messages {

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

/// One spherized cloud (Alg. 3), whole; it travels in CloudFragments.
struct SpherizedCloud {
  NodeId node;               ///< points are in base_link of this node
  double radius = 0.0;       ///< m, r_o
  double voxel = 0.0;        ///< m, edge of the voxels that the points were reduced to
  std::uint32_t points = 0;  ///< in the payload
  Bytes payload;             ///< Draco
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

/// `from` requests pieces of a cloud of `to`; no index means the whole.
struct CloudRequest {
  static constexpr std::size_t kMaxMissing = 256;
  AgentId from;
  AgentId to;
  NodeId node;
  std::vector<std::uint16_t> missing;
  float information = 0.0f;  ///< nats, of the alignment that `from` hopes for (graph::InformationGain)
};

/// The items that `from` holds, sent periodically so that others request what they lack. Each range has a
/// fingerprint of its contents (store::Store::node_print), so that two robots with other contents under the
/// same names detect it; a range may be divided to locate them (exchange::ContentCheck).
struct Digest {
  AgentId from;
  std::vector<SeqRange> nodes;
  std::vector<SeqRange> alignments;
  std::vector<std::uint32_t> node_prints = {};  ///< of each range of `nodes`
  std::vector<std::uint32_t> alignment_prints = {};
};

/// `from` requests items that the digest of `to` offered.
struct ItemRequest {
  AgentId from;
  AgentId to;
  std::vector<SeqRange> nodes;
  std::vector<SeqRange> alignments;
};

/// A part of its share of the radio's budget that a robot leaves to another one (exchange::BudgetShares).
struct Loan {
  AgentId borrower;
  std::uint16_t bytes_per_second = 0;
  bool operator==(const Loan&) const = default;
};

/// State of `from`, for people, for planning and for dividing the radio's budget.
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
  Health health = {};
};

/// An operator's order to stand still, to drive home or to drive on. The order with the latest stamp, among
/// those for the robot and those for all, is in force.
struct HoldOrder {
  enum class Kind : std::uint8_t {
    kResume,    ///< drive the mission
    kHold,      ///< stand still
    kHome,      ///< give all rows away and drive back to the start
    kHoldHome,  ///< stand still; the call home before stays in force
  };
  Stamp stamp;    ///< when it was given; raised above that of the order which it replaces, whatever the clock
  AgentId robot;  ///< empty: every robot
  AgentId issuer;  ///< for people
  Kind kind = Kind::kResume;
  bool operator==(const HoldOrder&) const = default;

  bool stops() const { return kind == Kind::kHold || kind == Kind::kHoldHome; }
  bool calls_home() const { return kind == Kind::kHome || kind == Kind::kHoldHome; }
};

/// An operator's order to give a row away. The order with the latest stamp for a row is in force.
struct RowOrder {
  Stamp stamp;            ///< as that of a HoldOrder
  AgentId robot;          ///< is not to drive it
  AgentId to;             ///< is to drive it; empty: the first other robot that is free
  AgentId issuer;         ///< for people
  std::uint32_t row = 0;  ///< its id in the mission
  bool operator==(const RowOrder&) const = default;
};

/// Orders that `from` gives (an operator, a button) or repeats (an agent, so that nobody misses them).
struct Hold {
  static constexpr std::size_t kMaxRows = 16;
  enum class Driving : std::uint8_t {
    kNoRobot,    ///< `from` is an operator
    kFree,       ///< `from` drives its mission
    kHeld,       ///< `from` stands by an order
    kNoMission,  ///< `from` obeys no orders: it is driven by another program
    kHome,       ///< `from` drives home by an order, or is there
  };
  AgentId from;
  Driving driving = Driving::kNoRobot;
  std::vector<HoldOrder> orders;
  std::vector<RowOrder> rows = {};
};

// ---- short range
// ----------------------------------------------------------------------------------------------

/// Which submaps `from` holds whole, and whom it hears on this link.
struct SubmapDigest {
  AgentId from;
  std::vector<SeqRange> submaps;
  std::vector<AgentId> hears;
};

/// `from` requests bytes [offset, offset + length) of an encoded submap of `to`.
struct SubmapRequest {
  AgentId from;
  AgentId to;
  NodeId node;
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
};

/// Bytes [offset, offset + payload) of an encoded submap of `from`, requested by `to`.
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

}  // namespace fleetmap::messages
