#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "fleetmap/core/result.hpp"

namespace fleetmap {

/// Name of a robot, unique in its fleet: 1 to 8 characters of [a-z0-9_-], the same on the wire and in files.
class AgentId {
 public:
  static constexpr std::size_t kMaxLength = 8;
  AgentId() = default;
  /// Fails with the rule that `name` breaks.
  static Result<AgentId> parse(std::string_view name);

  const std::string& str() const { return name_; }
  bool empty() const { return name_.empty(); }
  auto operator<=>(const AgentId&) const = default;

 private:
  explicit AgentId(std::string name) : name_(std::move(name)) {}
  std::string name_;
};

/// A node (and so its submap and its graph vertex). `seq` holds the session of `agent` in its upper 16 bits
/// and counts the nodes of that session in the lower ones, from 0 without gaps; alignments are numbered
/// likewise. Each start of a robot's program draws its session at random, so that a robot whose store was
/// lost, restored or replaced assigns no name twice.
struct NodeId {
  AgentId agent;
  std::uint32_t seq = 0;
  auto operator<=>(const NodeId&) const = default;
};

/// Items (nodes, submaps or alignments) [first, end) that `agent` made.
struct SeqRange {
  AgentId agent;
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  bool operator==(const SeqRange&) const = default;
};

inline constexpr std::uint32_t kItemsPerSession = 1u << 16;
/// Session 65535 is never drawn: the range of its last item would have no end.
inline constexpr std::uint32_t kEndOfSeqs = 0xffffu << 16;
constexpr std::uint32_t first_seq(std::uint16_t session) { return std::uint32_t{session} * kItemsPerSession; }
constexpr std::uint16_t session_of(std::uint32_t seq) {
  return static_cast<std::uint16_t>(seq / kItemsPerSession);
}

/// "r1/17", or "r1#4711/17" in session 4711.
std::string to_string(const NodeId& id);
/// Reads what to_string() writes. Fails for any other text.
Result<NodeId> parse_node_id(std::string_view text);

}  // namespace fleetmap

template <>
struct std::hash<fleetmap::AgentId> {
  std::size_t operator()(const fleetmap::AgentId& id) const noexcept {
    return std::hash<std::string>{}(id.str());
  }
};
template <>
struct std::hash<fleetmap::NodeId> {
  std::size_t operator()(const fleetmap::NodeId& id) const noexcept {
    return std::hash<fleetmap::AgentId>{}(id.agent) * 1000003u + id.seq;
  }
};
