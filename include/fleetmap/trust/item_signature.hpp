#pragma once

#include "fleetmap/trust/certificate.hpp"

namespace fleetmap::trust {

/// The kind of item that is signed; a signature of one kind is invalid for another.
enum class ItemKind : std::uint8_t { kNode = 1, kAlignment = 2 };

/// The maker's signature of an item that travels through third robots: Ed25519 of "fleetmap item 1", fleet,
/// kind and the item's canonical bytes (fleet_codec::signed_bytes). A submap is signed by its hash and size
/// in its node.
Signature sign_item(const SigningKey& maker, const FleetId& fleet, ItemKind kind, ByteView item);
bool verify_item(const PublicKey& maker, const FleetId& fleet, ItemKind kind, ByteView item,
                 const Signature& signature);

}  // namespace fleetmap::trust
