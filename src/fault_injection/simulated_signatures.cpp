#include "fleetmap/fault_injection/simulated_signatures.hpp"

#include <algorithm>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fault_injection {
namespace {

using exchange::ItemProof;

Bytes bytes_of(std::uint64_t value) {
  Bytes bytes(sizeof value);
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<std::uint8_t>(value >> (8 * k));
  return bytes;
}

/// The maker is named in `item`.
Signature keyed_hash(std::uint64_t secret, std::uint8_t kind, const Bytes& item) {
  Bytes all = bytes_of(secret);
  all.push_back(kind);
  all.insert(all.end(), item.begin(), item.end());
  Signature signature{};
  std::ranges::copy(content_hash(all), signature.begin());
  return signature;
}

template <class Item>
ItemProof proof_of(const Item& item, const Signature& genuine) {
  if (!item.signature) return ItemProof::kUnsigned;
  return *item.signature == genuine ? ItemProof::kGenuine : ItemProof::kWrong;
}

}  // namespace

Bytes SimulatedSignatures::fleet() const { return bytes_of(secret_); }

Signature SimulatedSignatures::sign(const graph::Node& node) const {
  return keyed_hash(secret_, 1, fleet_codec::signed_bytes(node));
}

Signature SimulatedSignatures::sign(const graph::Alignment& alignment) const {
  return keyed_hash(secret_, 2, fleet_codec::signed_bytes(alignment));
}

ItemProof SimulatedSignatures::verify(const graph::Node& node) const { return proof_of(node, sign(node)); }

ItemProof SimulatedSignatures::verify(const graph::Alignment& alignment) const {
  return proof_of(alignment, sign(alignment));
}

}  // namespace fleetmap::fault_injection
