#include "fleetmap/core/ids.hpp"

#include <algorithm>
#include <sstream>

namespace fleetmap {

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

}  // namespace fleetmap
