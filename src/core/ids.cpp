#include "fleetmap/core/ids.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

namespace fleetmap {
namespace {

template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Result<AgentId> AgentId::parse(std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (name.empty() || name.size() > kMaxLength || !std::ranges::all_of(name, allowed)) {
    return failure("agent id '" + std::string(name) + "' must be 1 to 8 characters of a-z, 0-9, '_' and '-'");
  }
  return AgentId(std::string(name));
}

std::string to_string(const NodeId& id) {
  const std::uint16_t session = session_of(id.seq);
  std::ostringstream text;
  text << id.agent.str();
  if (session > 0) text << '#' << session;
  text << '/' << id.seq - first_seq(session);
  return text.str();
}

Result<NodeId> parse_node_id(std::string_view text) {
  const auto wrong = [&] {
    std::string message = "no node is named ";
    message.append(text.substr(0, 40));
    return failure(std::move(message));
  };
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return wrong();
  std::string_view robot = text.substr(0, slash);
  std::optional<std::uint16_t> session = std::uint16_t{0};
  if (const std::size_t hash = robot.find('#'); hash != std::string_view::npos) {
    session = whole_number<std::uint16_t>(robot.substr(hash + 1));
    robot = robot.substr(0, hash);
  }
  const auto count = whole_number<std::uint32_t>(text.substr(slash + 1));
  const auto agent = AgentId::parse(robot);
  if (!agent || !session || !count || *count >= kItemsPerSession) return wrong();
  return NodeId{*agent, first_seq(*session) + *count};
}

}  // namespace fleetmap
