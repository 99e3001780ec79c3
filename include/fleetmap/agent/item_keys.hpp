#pragma once

#include <memory>
#include <vector>

#include "fleetmap/exchange/item_proof.hpp"
#include "fleetmap/trust/item_signature.hpp"

namespace fleetmap::trust {
struct Credentials;
}

namespace fleetmap::agent {

/// Signs items with the key of a robot's folder, and verifies those of others with the certificates that the
/// fleet's authority issued: those of the folder, and those that came in greetings since.
///
/// Expired and revoked certificates of a name count, too, because the items that a robot made stay in the map
/// when it gets new keys or is lost. The radios exclude the holder of a revoked key instead.
class ItemKeys final : public exchange::ItemAuthenticator {
 public:
  explicit ItemKeys(std::shared_ptr<const trust::Credentials> credentials);

  Bytes fleet() const override;
  Signature sign(const graph::Node& node) const override;
  Signature sign(const graph::Alignment& alignment) const override;
  exchange::ItemProof verify(const graph::Node& node) const override;
  exchange::ItemProof verify(const graph::Alignment& alignment) const override;

 private:
  std::vector<trust::PublicKey> keys_of(const AgentId& maker) const;
  exchange::ItemProof verify(const AgentId& maker, trust::ItemKind kind, ByteView item,
                             const std::optional<Signature>& signature) const;

  std::shared_ptr<const trust::Credentials> credentials_;
};

}  // namespace fleetmap::agent
