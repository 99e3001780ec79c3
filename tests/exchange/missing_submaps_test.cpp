#include "missing_submaps.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;

const AgentId kSelf = agent("r1"), kMaker = agent("r2"), kThird = agent("r3");
const std::vector<AgentId> kFleet{kSelf, kMaker, kThird};
const Stamp kStart = stamp_from_ns(1'000'000'000'000);
const Stamp kLater = kStart + std::chrono::seconds(31);
const NodeId kNode{kMaker, 0};

/// A store with a node of r2 whose submap is not there.
class MissingSubmapsTest : public ::testing::Test {
 protected:
  MissingSubmapsTest() {
    EXPECT_EQ(store_.put_node(testing::make_node(kMaker, 0, submap_)).value(), store::Put::kAdded);
    missing_.add(kNode, kStart);
  }
  void deny(const AgentId& name, Stamp now) { neighbours_.on_digest({name, {}, {}}, now); }
  bool complete(const std::set<AgentId>& without = {}) const {
    return missing_.complete(store_, members_, neighbours_, without);
  }

  Bytes submap_ = testing::random_bytes(100, 1);
  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_ / "store.db", kSelf).value());
  Membership members_{kSelf, kFleet};
  NeighbourTable neighbours_{kSelf, {}};
  MissingSubmaps missing_;
};

TEST_F(MissingSubmapsTest, IsCompleteOnceTheSubmapIsHeld) {
  EXPECT_FALSE(complete());
  ASSERT_EQ(store_.put_submap_chunk(kNode, 0, submap_).value(), store::Put::kAdded);
  EXPECT_TRUE(complete());
}

TEST_F(MissingSubmapsTest, IsCompleteWithoutASubmapThatAllOthersDenyLateEnough) {
  deny(kMaker, kLater);
  EXPECT_FALSE(complete()) << "the third robot was not heard";
  deny(kThird, kStart);
  EXPECT_FALSE(complete()) << "its digest may be older than its copy of the submap";
  deny(kThird, kLater);
  EXPECT_TRUE(complete());
  neighbours_.on_digest({kThird, {{kMaker, 0, 1}}, {}}, kLater);
  EXPECT_FALSE(complete());
}

TEST_F(MissingSubmapsTest, SubmapsOfALostRobotThatNoOtherHoldsAreNotWaitedFor) {
  EXPECT_FALSE(complete({kMaker}));
  deny(kThird, kStart);
  EXPECT_TRUE(complete({kMaker}));
  EXPECT_FALSE(complete({kThird})) << "its maker is there";
}

}  // namespace
}  // namespace fleetmap::exchange
