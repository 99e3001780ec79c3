#include "attacker.hpp"

#include <algorithm>
#include <utility>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr std::size_t kOverheard = 256;
constexpr std::uint64_t kAttackStream = 6;
constexpr std::size_t kInventedNames = 20;  ///< in a forged digest of submaps

const AgentId& mallory() {
  static const AgentId name = AgentId::parse("mallory").value();
  return name;
}

graph::Node node_of(const NodeId& id) {
  graph::Node node;
  node.id = id;
  node.session = session_of(id.seq);
  return node;
}

/// Every number of every robot.
std::vector<SeqRange> everything(const std::vector<AgentId>& fleet) {
  std::vector<SeqRange> all;
  for (const AgentId& agent : fleet) all.push_back({agent, 0, kEndOfSeqs});
  return all;
}

}  // namespace

Attacker::Attacker(std::uint64_t seed, std::vector<AgentId> fleet, bool signatures)
    : draws_(seed, kAttackStream), fleet_(std::move(fleet)), signatures_(signatures) {}

void Attacker::overhear(const Packet& packet) {
  if (draws_.chance(0.9)) return;
  overheard_.push_back(packet.outgoing);
  if (overheard_.size() > kOverheard) overheard_.pop_front();
}

NodeId Attacker::any_id() {
  // Mostly the next numbers of the sessions that are heard, sometimes any number or the last one of them.
  for (const messages::Outgoing& outgoing : overheard_) {
    const auto* node = std::get_if<graph::Node>(&outgoing.message);
    if (!node || draws_.chance(0.8)) continue;
    const auto& [agent, seq] = node->id;
    if (draws_.chance(0.8)) return {agent, seq + static_cast<std::uint32_t>(draws_.below(8))};
    const std::uint32_t first = first_seq(session_of(seq));
    if (draws_.chance(0.5))
      return {agent, first + static_cast<std::uint32_t>(draws_.below(kItemsPerSession))};
    return {agent, first + kItemsPerSession - 1};
  }
  if (draws_.chance(0.2)) return {anyone(), kEndOfSeqs - 1};
  return {anyone(), static_cast<std::uint32_t>(draws_.below(kEndOfSeqs))};
}

Attacker::Injected Attacker::to_anyone(messages::Message message, messages::Reach reach) {
  const AgentId to = messages::recipient_of(message).value_or(anyone());
  return {to, reach, std::make_shared<const messages::Message>(std::move(message))};
}

std::optional<Attacker::Injected> Attacker::stranger() {
  const auto reach = draws_.chance(0.5) ? messages::Reach::kLongRange : messages::Reach::kShortRange;
  const AgentId to = anyone();
  switch (draws_.below(7)) {
    case 0:
      return to_anyone(messages::Digest{mallory(), everything(fleet_), everything(fleet_)}, reach);
    case 1:
      return to_anyone(node_of({mallory(), static_cast<std::uint32_t>(draws_.below(1000))}), reach);
    case 2:
      return to_anyone(messages::ItemRequest{mallory(), to, everything(fleet_), everything(fleet_)}, reach);
    case 3:
      return to_anyone(messages::SubmapDigest{mallory(), everything(fleet_), fleet_}, reach);
    case 4:
      return to_anyone(messages::SubmapRequest{mallory(), to, any_id(), 0, 1u << 20}, reach);
    case 5:
      return to_anyone(messages::CloudRequest{mallory(), to, any_id(), {}, 100.0f}, reach);
    default: {
      if (overheard_.empty()) return {};
      const messages::Outgoing& again = overheard_[draws_.below(overheard_.size())];
      return to_anyone(again.message, again.reach);
    }
  }
}

messages::Message Attacker::forged_item() {
  const NodeId id = any_id();
  if (draws_.chance(0.6)) {
    const graph::Node node = node_of(id);
    return fleet_codec::quantised(node).value_or(node);
  }
  graph::Alignment alignment;
  alignment.i = any_id();
  alignment.j = any_id();
  alignment.computed_by = id.agent;
  alignment.seq = id.seq;
  return fleet_codec::quantised(alignment).value_or(alignment);
}

messages::Message Attacker::forged_digest() {
  if (draws_.chance(0.5))
    return messages::Digest{anyone(), {{anyone(), 0, kEndOfSeqs}}, {{anyone(), 0, kEndOfSeqs}}};
  messages::SubmapDigest digest{anyone(), {}, fleet_};
  for (std::size_t k = 0; k < kInventedNames; ++k) {
    const std::string name = std::string("x").append(std::to_string(draws_.below(10'000)));
    digest.submaps.push_back({AgentId::parse(name).value(), 0, 5});
  }
  return digest;
}

std::optional<messages::Message> Attacker::forged_chunk() {
  const graph::Node* largest = nullptr;
  for (const messages::Outgoing& outgoing : overheard_) {
    const auto* node = std::get_if<graph::Node>(&outgoing.message);
    if (node && (!largest || node->submap_bytes > largest->submap_bytes)) largest = node;
  }
  if (!largest || largest->submap_bytes <= store::Store::kChunkBytes) return {};
  return messages::SubmapChunk{
      anyone(), anyone(), largest->id, 0, largest->submap_bytes, Bytes(store::Store::kChunkBytes, 0x5a)};
}

std::optional<Signature> Attacker::overheard_signature() {
  for (const messages::Outgoing& outgoing : overheard_) {
    const auto* node = std::get_if<graph::Node>(&outgoing.message);
    if (node && draws_.chance(0.2)) return node->signature;
  }
  return {};
}

messages::Message Attacker::with_false_signature(messages::Message item) {
  if (!signatures_) return item;
  std::optional<Signature> signature = overheard_signature();
  if (!signature && draws_.chance(0.5)) {
    for (auto& byte : signature.emplace()) byte = static_cast<std::uint8_t>(draws_.bits());
  }
  if (auto* node = std::get_if<graph::Node>(&item)) node->signature = signature;
  if (auto* alignment = std::get_if<graph::Alignment>(&item)) alignment->signature = signature;
  return item;
}

std::optional<messages::Message> Attacker::damaged() {
  if (overheard_.empty()) return {};
  const messages::Outgoing& outgoing = overheard_[draws_.below(overheard_.size())];
  Bytes cdr = fleet_codec::encode(outgoing.message);
  for (std::size_t k = 0; k < 1 + draws_.below(4); ++k)
    cdr[draws_.below(cdr.size())] ^= static_cast<std::uint8_t>(1u << draws_.below(8));
  auto message = fleet_codec::decode_message(fleet_codec::topic_of(outgoing), cdr);
  if (!message) return {};
  return std::move(*message);
}

std::optional<Attacker::Injected> Attacker::forged() {
  const auto reach = draws_.chance(0.5) ? messages::Reach::kLongRange : messages::Reach::kShortRange;
  switch (draws_.below(5)) {
    case 0:
      return to_anyone(forged_digest(), reach);
    case 1:
    case 2: {
      auto message = draws_.chance(0.5) ? damaged() : forged_chunk();
      if (!message) return {};
      return to_anyone(std::move(*message), reach);
    }
    default:
      return to_anyone(with_false_signature(forged_item()), reach);
  }
}

std::optional<Attacker::Injected> Attacker::forged_claim() {
  const auto reach = draws_.chance(0.5) ? messages::Reach::kLongRange : messages::Reach::kShortRange;
  if (draws_.chance(0.5)) return to_anyone(forged_digest(), reach);
  auto chunk = forged_chunk();
  if (!chunk) return {};
  return to_anyone(std::move(*chunk), reach);
}

messages::Message Attacker::lie(messages::Message message, const AgentId& liar) {
  if (auto* digest = std::get_if<messages::Digest>(&message)) {
    digest->nodes = digest->alignments = everything(fleet_);
  } else if (auto* submaps = std::get_if<messages::SubmapDigest>(&message)) {
    submaps->submaps = everything(fleet_);
    submaps->hears = fleet_;
  } else if (auto* status = std::get_if<messages::AgentStatus>(&message)) {
    status->backlog_bytes = UINT32_MAX;
    status->busy = true;
  } else if (auto* chunk = std::get_if<messages::SubmapChunk>(&message)) {
    for (auto& byte : chunk->payload) byte = static_cast<std::uint8_t>(draws_.bits());
  } else if (auto* fragment = std::get_if<messages::CloudFragment>(&message)) {
    for (auto& byte : fragment->payload) byte = static_cast<std::uint8_t>(draws_.bits());
  }
  if (!signatures_) return message;
  // Without signatures it could take the name of any item that it hands over.
  if (auto* node = std::get_if<graph::Node>(&message); node && node->id.agent != liar && draws_.chance(0.5))
    node->T_odom_base.translation().x() += 10.0;
  if (auto* alignment = std::get_if<graph::Alignment>(&message);
      alignment && alignment->computed_by != liar && draws_.chance(0.5))
    alignment->signature.reset();
  return message;
}

}  // namespace fleetmap::fault_injection
