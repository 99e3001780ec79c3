#include "fleetmap/trust/item_signature.hpp"

#include "joined.hpp"

namespace fleetmap::trust {
namespace {

Bytes signed_bytes(const FleetId& fleet, ItemKind kind, ByteView item) {
  const std::uint8_t kind_byte = static_cast<std::uint8_t>(kind);
  return joined({bytes_of("fleetmap item 1"), fleet, {&kind_byte, 1}, item});
}

}  // namespace

Signature sign_item(const SigningKey& maker, const FleetId& fleet, ItemKind kind, ByteView item) {
  return maker.sign(signed_bytes(fleet, kind, item));
}

bool verify_item(const PublicKey& maker, const FleetId& fleet, ItemKind kind, ByteView item,
                 const Signature& signature) {
  return verify(maker, signed_bytes(fleet, kind, item), signature);
}

}  // namespace fleetmap::trust
