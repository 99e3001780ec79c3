#include "fleetmap/trust/item_signature.hpp"

#include <gtest/gtest.h>

namespace fleetmap::trust {
namespace {

TEST(ItemSignature, HoldsForThisItemKindFleetAndMaker) {
  const SigningKey maker = SigningKey::generate();
  const FleetId fleet{1, 2, 3, 4, 5, 6, 7, 8};
  Bytes item(270, 5);
  const Signature signature = sign_item(maker, fleet, ItemKind::kNode, item);
  const auto holds = [&](const PublicKey& key, const FleetId& of, ItemKind kind) {
    return verify_item(key, of, kind, item, signature);
  };
  EXPECT_TRUE(holds(maker.public_key(), fleet, ItemKind::kNode));
  EXPECT_FALSE(holds(SigningKey::generate().public_key(), fleet, ItemKind::kNode));
  EXPECT_FALSE(holds(maker.public_key(), {9}, ItemKind::kNode));
  EXPECT_FALSE(holds(maker.public_key(), fleet, ItemKind::kAlignment));
  for (std::size_t k = 0; k < item.size(); ++k) {
    item[k] ^= 1;
    EXPECT_FALSE(holds(maker.public_key(), fleet, ItemKind::kNode)) << "byte " << k;
    item[k] ^= 1;
  }
}

TEST(ItemSignature, OfAGreetingIsNone) {
  const SigningKey maker = SigningKey::generate();
  const Bytes item(100, 1);
  EXPECT_FALSE(verify_item(maker.public_key(), {}, ItemKind::kNode, item, maker.sign(item)));
}

}  // namespace
}  // namespace fleetmap::trust
