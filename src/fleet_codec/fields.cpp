#include "fields.hpp"

#include <algorithm>
#include <string_view>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fleet_codec {
namespace {

constexpr double kMaxDistance = 1e7;  // m from the start of an odometry frame; a quarter of the Earth
constexpr double kMaxAltitude = 1e5;  // m
constexpr std::int64_t kMaxStamp = std::int64_t{1} << 62;

}  // namespace

AgentName agent_name(const AgentId& agent) {
  AgentName octets{};
  std::copy(agent.str().begin(), agent.str().end(), octets.begin());
  return octets;
}

msg::NodeRef node_ref(const NodeId& node) {
  msg::NodeRef ref;
  ref.agent(agent_name(node.agent));
  ref.seq(node.seq);
  return ref;
}

std::vector<msg::Range> ranges(const std::vector<SeqRange>& ranges, std::size_t limit) {
  std::vector<msg::Range> out(std::min(ranges.size(), limit));
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].agent(agent_name(ranges[k].agent));
    out[k].first(ranges[k].first);
    out[k].end(ranges[k].end);
  }
  return out;
}

Bytes bounded(const Bytes& payload, std::size_t limit) {
  return {payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(std::min(payload.size(), limit))};
}

Bytes signature_bytes(const std::optional<Signature>& signature) {
  return signature ? Bytes(signature->begin(), signature->end()) : Bytes();
}

float to_float(double value) {
  constexpr double kLimit = std::numeric_limits<float>::max();
  return static_cast<float>(std::isnan(value) ? value : std::clamp(value, -kLimit, kLimit));
}

std::array<float, 3> to_floats(const Eigen::Vector3d& v) {
  return {to_float(v.x()), to_float(v.y()), to_float(v.z())};
}

void FieldCheck::refuse(const std::string& what) {
  if (broken_.empty()) broken_ = std::string(type_) + ": " + what;
}

void FieldCheck::require(bool holds, const char* rule) {
  if (!holds) refuse(rule);
}

AgentId FieldCheck::agent(const AgentName& octets, const char* member) {
  const auto end = std::find(octets.begin(), octets.end(), 0);
  if (!std::all_of(end, octets.end(), [](std::uint8_t octet) { return octet == 0; })) {
    refuse(std::string(member) + ": agent id is not padded with zeros");
    return {};
  }
  auto agent = AgentId::parse(std::string(octets.begin(), end));
  if (!agent) {
    // The text of the error would repeat arbitrary bytes from the network.
    refuse(std::string(member) + ": agent id must be 1 to 8 characters of a-z, 0-9, '_' and '-'");
    return {};
  }
  return *agent;
}

std::uint32_t FieldCheck::seq(std::uint32_t value, const char* member) {
  if (value >= kEndOfSeqs)
    refuse(std::string(member) + ": sequence number " + std::to_string(value) + " is too large");
  return value;
}

NodeId FieldCheck::node(const AgentName& octets, std::uint32_t value, const char* member) {
  return {agent(octets, member), seq(value, member)};
}

std::vector<SeqRange> FieldCheck::ranges(const std::vector<msg::Range>& ranges, std::size_t limit,
                                         const char* member) {
  if (ranges.size() > limit) refuse(std::string(member) + ": more than " + std::to_string(limit) + " ranges");
  std::vector<SeqRange> out;
  for (std::size_t k = 0; k < std::min(ranges.size(), limit); ++k) {
    const auto& range = ranges[k];
    if (range.first() > range.end() || range.end() > kEndOfSeqs) {
      refuse(std::string(member) + ": range [" + std::to_string(range.first()) + ", " +
             std::to_string(range.end()) + ") is out of order or too large");
    }
    out.push_back({agent(range.agent(), member), range.first(), range.end()});
  }
  return out;
}

Stamp FieldCheck::stamp(std::int64_t ns) {
  const bool plausible = ns >= 0 && ns <= kMaxStamp;
  require(plausible, "stamp is outside 1970 to 2116");
  return stamp_from_ns(plausible ? ns : 0);
}

GeoPoint FieldCheck::position(double latitude, double longitude, double altitude) {
  const GeoPoint point{latitude, longitude, altitude};
  require(is_valid(point) && std::abs(altitude) <= kMaxAltitude, "position is not on Earth");
  return point;
}

double FieldCheck::within(double value, double limit, const char* member) {
  if (!(std::abs(value) <= limit)) refuse(std::string(member) + " is not finite or beyond its range");
  return value;
}

double FieldCheck::size(double value, double limit, const char* member) {
  if (!(value >= 0.0 && value <= limit))
    refuse(std::string(member) + " is negative, not finite or too large");
  return value;
}

std::optional<Signature> FieldCheck::signature(const Bytes& bytes) {
  Signature signature{};
  require(bytes.empty() || bytes.size() == signature.size(), "the signature has not 64 bytes");
  if (bytes.size() != signature.size()) return std::nullopt;
  std::ranges::copy(bytes, signature.begin());
  return signature;
}

Eigen::Vector3d FieldCheck::translation(const std::array<float, 3>& t, const char* member) {
  return {within(static_cast<double>(t[0]), kMaxDistance, member),
          within(static_cast<double>(t[1]), kMaxDistance, member),
          within(static_cast<double>(t[2]), kMaxDistance, member)};
}

}  // namespace fleetmap::fleet_codec
