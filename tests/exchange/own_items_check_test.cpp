#include "own_items_check.hpp"

#include <gtest/gtest.h>

#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::make_node;

constexpr std::uint16_t kSession = 7;

/// A store with two own nodes of the running session.
class OwnItemsCheckTest : public ::testing::Test {
 protected:
  OwnItemsCheckTest() {
    for (std::uint32_t k = 0; k < 2; ++k) {
      const Bytes submap = testing::random_bytes(100, k);
      graph::Node node = make_node(kSelf, first_ + k, submap);
      node.session = kSession;
      EXPECT_EQ(store_.put_node_with_submap(node, submap).value(), store::Put::kAdded);
    }
  }
  std::vector<Event> on(std::vector<SeqRange> nodes) {
    return check_.on_digest({kPeer, std::move(nodes), {}}, store_);
  }

  std::uint32_t first_ = first_seq(kSession);
  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_ / "store.db", kSelf).value());
  OwnItemsCheck check_{kSelf};
};

TEST_F(OwnItemsCheckTest, DigestsOfHeldItemsAndOfOtherRobotsReportNothing) {
  check_.begin_session(kSession);
  EXPECT_TRUE(on({{kSelf, first_, first_ + 2}, {kPeer, 0, 99}}).empty());
}

TEST_F(OwnItemsCheckTest, ItemsThatOurStoreLacksAreReportedOnce) {
  const std::vector<Event> events = on({{kSelf, 0, 5}});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(std::get<OwnItemsElsewhere>(events[0]).nodes, 5u);
  EXPECT_TRUE(on({{kSelf, 0, 6}}).empty());
}

TEST_F(OwnItemsCheckTest, ItemsBeyondTheNextOfTheRunningSessionProveThatItIsTaken) {
  check_.begin_session(kSession);
  const std::vector<Event> events = on({{kSelf, first_, first_ + 3}});
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(std::get<SessionTaken>(events[0]).peer, kPeer);
}

TEST_F(OwnItemsCheckTest, OtherSessionsDoNotTakeTheRunningOne) {
  check_.begin_session(kSession);
  const std::uint32_t next = first_seq(kSession + 1);
  for (const Event& event : on({{kSelf, next, next + 3}}))
    EXPECT_FALSE(std::holds_alternative<SessionTaken>(event));
}

}  // namespace
}  // namespace fleetmap::exchange
