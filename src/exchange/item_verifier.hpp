#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <tuple>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/exchange/item_proof.hpp"

namespace fleetmap::exchange {

/// Signs own items and verifies those of others, where the fleet has keys. Without an authenticator items
/// have no signatures, and all are accepted.
class ItemVerifier {
 public:
  explicit ItemVerifier(std::shared_ptr<const ItemAuthenticator> authenticator)
      : authenticator_(std::move(authenticator)) {}

  bool has_keys() const { return authenticator_ != nullptr; }
  /// An own item with the signature of this robot; without keys, with none.
  template <class Item>
  Item with_signature(Item item) const {
    item.signature.reset();
    if (authenticator_) item.signature = authenticator_->sign(item);
    return item;
  }
  /// The item as it is stored: without keys its signature is dropped, so that every signature in a store was
  /// verified.
  template <class Item>
  Item to_store(Item item) const {
    if (!authenticator_) item.signature.reset();
    return item;
  }
  /// Verifies the item's signature and counts the result.
  template <class Item>
  ItemProof verify(const Item& item) {
    if (!authenticator_) return ItemProof::kGenuine;
    const ItemProof proof = authenticator_->verify(item);
    ++proofs_[static_cast<std::size_t>(proof)];
    return proof;
  }
  /// True the first time that an item of `maker` from `sender` is refused because of `proof`, for the first
  /// 64 such cases.
  bool is_new_refusal(const AgentId& maker, const AgentId& sender, ItemProof proof) {
    constexpr std::size_t kMaxReported = 64;
    return refusals_.size() < kMaxReported && refusals_.insert({maker, sender, proof}).second;
  }

  const std::array<std::uint64_t, kItemProofs>& proofs() const { return proofs_; }
  std::size_t reported_refusals() const { return refusals_.size(); }

 private:
  std::shared_ptr<const ItemAuthenticator> authenticator_;
  std::array<std::uint64_t, kItemProofs> proofs_{};
  std::set<std::tuple<AgentId, AgentId, ItemProof>> refusals_;  ///< maker, sender, reason
};

}  // namespace fleetmap::exchange
