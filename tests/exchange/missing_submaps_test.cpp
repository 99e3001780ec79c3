#include "missing_submaps.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

const Stamp kLater = kStart + std::chrono::seconds(31);
const NodeId kMissing{kPeer, 0};

/// A store with a node of r2 whose submap is not there.
class MissingSubmapsTest : public ::testing::Test {
 protected:
  MissingSubmapsTest() {
    EXPECT_EQ(store_.put_node(testing::make_node(kPeer, 0, submap_)).value(), store::Put::kAdded);
    missing_.add(kMissing, kStart);
  }
  void deny(const AgentId& name, Stamp now) { neighbours_.on_digest({name, {}, {}}, now); }
  bool complete(const std::set<AgentId>& without = {}) const {
    return missing_.complete(store_, members_, neighbours_, without);
  }

  Bytes submap_ = testing::random_bytes(100, 1);
  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_ / "store.db", kSelf).value());
  std::vector<AgentId> fleet_{kSelf, kPeer, kThird};
  Membership members_{kSelf, fleet_};
  NeighbourTable neighbours_{kSelf, {}};
  MissingSubmaps missing_;
};

TEST_F(MissingSubmapsTest, IsCompleteOnceTheSubmapIsHeld) {
  EXPECT_FALSE(complete());
  ASSERT_EQ(store_.put_submap_chunk(kMissing, 0, submap_).value(), store::Put::kAdded);
  EXPECT_TRUE(complete());
}

TEST_F(MissingSubmapsTest, IsCompleteWithoutASubmapThatAllOthersDenyLateEnough) {
  deny(kPeer, kLater);
  EXPECT_FALSE(complete()) << "the third robot was not heard";
  deny(kThird, kStart);
  EXPECT_FALSE(complete()) << "its digest may be older than its copy of the submap";
  deny(kThird, kLater);
  EXPECT_TRUE(complete());
  neighbours_.on_digest({kThird, {{kPeer, 0, 1}}, {}}, kLater);
  EXPECT_FALSE(complete());
}

TEST_F(MissingSubmapsTest, SubmapsOfALostRobotThatNoOtherHoldsAreNotWaitedFor) {
  EXPECT_FALSE(complete({kPeer}));
  deny(kThird, kStart);
  EXPECT_TRUE(complete({kPeer}));
  EXPECT_FALSE(complete({kThird})) << "its maker is there";
}

}  // namespace
}  // namespace fleetmap::exchange
