#include "item_verifier.hpp"

#include <gtest/gtest.h>

#include <string>

#include "exchange/robots.hpp"
#include "fleetmap/fault_injection/simulated_signatures.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;

TEST(ItemVerifier, WithoutKeysItemsAreAcceptedAndKeepNoSignature) {
  ItemVerifier verifier(nullptr);
  graph::Node node = testing::make_node(kMaker, 0, {});
  node.signature.emplace();
  EXPECT_EQ(verifier.verify(node), ItemProof::kGenuine);
  EXPECT_FALSE(verifier.with_signature(node).signature);
  EXPECT_FALSE(verifier.to_store(node).signature);
  EXPECT_EQ(verifier.proofs(), (std::array<std::uint64_t, kItemProofs>{}));
}

TEST(ItemVerifier, WithKeysEveryResultIsCounted) {
  ItemVerifier verifier(std::make_shared<fault_injection::SimulatedSignatures>(1));
  const graph::Node made = testing::make_node(kMaker, 0, {});
  const graph::Node node = verifier.with_signature(made);
  EXPECT_EQ(verifier.verify(node), ItemProof::kGenuine);
  EXPECT_TRUE(verifier.to_store(node).signature);
  graph::Node forged = node;
  forged.id.seq = 1;
  EXPECT_EQ(verifier.verify(forged), ItemProof::kWrong);
  forged.signature.reset();
  EXPECT_EQ(verifier.verify(forged), ItemProof::kUnsigned);
  EXPECT_EQ(verifier.verify(forged), ItemProof::kUnsigned);
  EXPECT_EQ(verifier.proofs(), (std::array<std::uint64_t, kItemProofs>{1, 2, 1, 0}));
}

TEST(ItemVerifier, EachRefusalIsNewOnceAndAtMost64Are) {
  ItemVerifier verifier(nullptr);
  EXPECT_TRUE(verifier.is_new_refusal(kMaker, kPeer, ItemProof::kWrong));
  EXPECT_FALSE(verifier.is_new_refusal(kMaker, kPeer, ItemProof::kWrong));
  EXPECT_TRUE(verifier.is_new_refusal(kMaker, kPeer, ItemProof::kUnsigned));
  EXPECT_TRUE(verifier.is_new_refusal(kMaker, kMaker, ItemProof::kWrong));
  for (int k = 0; k < 100; ++k)
    verifier.is_new_refusal(agent("x" + std::to_string(k)), kPeer, ItemProof::kWrong);
  EXPECT_EQ(verifier.reported_refusals(), 64u);
}

}  // namespace
}  // namespace fleetmap::exchange
