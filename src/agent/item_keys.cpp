#include "fleetmap/agent/item_keys.hpp"

#include <algorithm>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/trust/credentials.hpp"

namespace fleetmap::agent {

using exchange::ItemProof;
using trust::ItemKind;

ItemKeys::ItemKeys(std::shared_ptr<const trust::Credentials> credentials)
    : credentials_(std::move(credentials)) {}

Bytes ItemKeys::fleet() const {
  const trust::FleetId& fleet = credentials_->authority.fleet;
  return {fleet.begin(), fleet.end()};
}

Signature ItemKeys::sign(const graph::Node& node) const {
  return trust::sign_item(credentials_->key, credentials_->authority.fleet, ItemKind::kNode,
                          fleet_codec::signed_bytes(node));
}

Signature ItemKeys::sign(const graph::Alignment& alignment) const {
  return trust::sign_item(credentials_->key, credentials_->authority.fleet, ItemKind::kAlignment,
                          fleet_codec::signed_bytes(alignment));
}

ItemProof ItemKeys::verify(const graph::Node& node) const {
  return verify(node.id.agent, ItemKind::kNode, fleet_codec::signed_bytes(node), node.signature);
}

ItemProof ItemKeys::verify(const graph::Alignment& alignment) const {
  return verify(alignment.computed_by, ItemKind::kAlignment, fleet_codec::signed_bytes(alignment),
                alignment.signature);
}

std::vector<trust::PublicKey> ItemKeys::keys_of(const AgentId& maker) const {
  std::vector<trust::PublicKey> keys;
  const auto add = [&](const trust::Certificate& certificate) {
    const bool may_map = certificate.name == maker && certificate.role == trust::Role::kRobot;
    if (may_map && std::ranges::find(keys, certificate.key) == keys.end()) keys.push_back(certificate.key);
  };
  add(credentials_->certificate);
  std::ranges::for_each(credentials_->members, add);
  std::ranges::for_each(credentials_->learned->all(), add);
  return keys;
}

ItemProof ItemKeys::verify(const AgentId& maker, ItemKind kind, ByteView item,
                           const std::optional<Signature>& signature) const {
  if (!signature) return ItemProof::kUnsigned;
  const std::vector<trust::PublicKey> keys = keys_of(maker);
  if (keys.empty()) return ItemProof::kUnknownMaker;
  const bool genuine = std::ranges::any_of(keys, [&](const trust::PublicKey& key) {
    return trust::verify_item(key, credentials_->authority.fleet, kind, item, *signature);
  });
  return genuine ? ItemProof::kGenuine : ItemProof::kWrong;
}

}  // namespace fleetmap::agent
