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

/// A node (and so its submap and its graph vertex): the seq-th that `agent` froze, counted from 0 without
/// gaps.
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

/// "r1/17"
std::string to_string(const NodeId& id);

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
