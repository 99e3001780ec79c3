#include "fleetmap/fault_injection/simulated_signatures.hpp"

#include <gtest/gtest.h>

#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using exchange::ItemProof;
using fleetmap::testing::agent;
using fleetmap::testing::make_alignment;
using fleetmap::testing::make_node;

class SimulatedSignaturesTest : public ::testing::Test {
 protected:
  SimulatedSignatures fleet_{42};
  graph::Node node_ = make_node(agent("r1"), 3, {1, 2, 3});
  graph::Alignment alignment_ = make_alignment({agent("r1"), 3}, {agent("r2"), 5}, agent("r1"), 0);
};

TEST_F(SimulatedSignaturesTest, ItemsSignedByTheFleetAreGenuine) {
  EXPECT_EQ(fleet_.verify(node_), ItemProof::kUnsigned);
  EXPECT_EQ(fleet_.verify(alignment_), ItemProof::kUnsigned);
  node_.signature = fleet_.sign(node_);
  alignment_.signature = fleet_.sign(alignment_);
  EXPECT_EQ(fleet_.verify(node_), ItemProof::kGenuine);
  EXPECT_EQ(fleet_.verify(alignment_), ItemProof::kGenuine);
  EXPECT_EQ(SimulatedSignatures(42).verify(node_), ItemProof::kGenuine) << "any robot's object will do";
}

TEST_F(SimulatedSignaturesTest, AnyChangeShows) {
  node_.signature = fleet_.sign(node_);
  graph::Node other = node_;
  other.id.seq = 4;
  EXPECT_EQ(fleet_.verify(other), ItemProof::kWrong);
  other = node_;
  other.id.agent = agent("r2");
  EXPECT_EQ(fleet_.verify(other), ItemProof::kWrong);
  other = node_;
  other.submap_hash[15] ^= 1;
  EXPECT_EQ(fleet_.verify(other), ItemProof::kWrong);
  other = node_;
  other.signature->front() ^= 1;
  EXPECT_EQ(fleet_.verify(other), ItemProof::kWrong);
  alignment_.signature = fleet_.sign(alignment_);
  alignment_.modes[0].rmse += 0.01;
  EXPECT_EQ(fleet_.verify(alignment_), ItemProof::kWrong);
}

TEST_F(SimulatedSignaturesTest, AnotherFleetsSignatureIsWrong) {
  const SimulatedSignatures other(43);
  EXPECT_NE(other.fleet(), fleet_.fleet());
  EXPECT_EQ(SimulatedSignatures(42).fleet(), fleet_.fleet());
  node_.signature = other.sign(node_);
  EXPECT_EQ(fleet_.verify(node_), ItemProof::kWrong);
}

}  // namespace
}  // namespace fleetmap::fault_injection
