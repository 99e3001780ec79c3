#include "fleetmap/store/sessions.hpp"

#include <gtest/gtest.h>

#include <set>

#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::kSelf;

class SessionsTest : public ::testing::Test {
 protected:
  Store open() { return std::move(Store::open(folder_ / "store.db", kSelf).value()); }
  /// Gives these numbers, one after the other.
  static Sessions::Draw numbers(std::vector<std::uint16_t> drawn) {
    return [drawn, k = std::size_t{0}]() mutable { return drawn.at(k++); };
  }
  testing::TemporaryFolder folder_;
};

TEST_F(SessionsTest, AreKnownByTheirOrderAfterARestart) {
  {
    Store store = open();
    Sessions sessions = Sessions::load(store).value();
    EXPECT_EQ(sessions.begin(store, numbers({700})).value(), 700);
    EXPECT_EQ(sessions.begin(store, numbers({20})).value(), 20);
  }
  Store store = open();
  Sessions sessions = Sessions::load(store).value();
  EXPECT_EQ(sessions.begin(store, numbers({700, 20, 5})).value(), 5)
      << "two had begun, though without a node";
  EXPECT_EQ(sessions.index_of(700), 0u);
  EXPECT_EQ(sessions.index_of(20), 1u);
  EXPECT_EQ(sessions.index_of(5), 2u);
  EXPECT_EQ(sessions.index_of(6), std::nullopt);
}

TEST_F(SessionsTest, PassOverNumbersThatOwnItemsBear) {
  Store store = open();
  // As others give them back after the store was lost.
  ASSERT_EQ(store.put_node(testing::make_node(kSelf, first_seq(3) + 17, Bytes{})).value(),
            store::Put::kAdded);
  ASSERT_EQ(store.put_alignment(testing::make_alignment({kSelf, 1}, {kSelf, 2}, kSelf, first_seq(4))).value(),
            store::Put::kAdded);
  const AgentId other = *AgentId::parse("r2");
  ASSERT_EQ(store.put_node(testing::make_node(other, first_seq(6), Bytes{})).value(), store::Put::kAdded);
  Sessions sessions = Sessions::load(store).value();
  EXPECT_EQ(sessions.begin(store, numbers({3, 4, 65535, 6})).value(), 6);
  EXPECT_EQ(store.next_node_seq(3), first_seq(3) + 18);
  EXPECT_EQ(store.next_node_seq(6), first_seq(6));
}

TEST_F(SessionsTest, ASourceThatIsNotRandomFails) {
  Store store = open();
  Sessions sessions = Sessions::load(store).value();
  const auto always = [] { return std::uint16_t{7}; };
  ASSERT_TRUE(sessions.begin(store, always));
  const auto again = sessions.begin(store, always);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("store.db"), std::string::npos);
}

TEST(RandomSession, HardlyEverComesTwice) {
  std::set<std::uint16_t> drawn;
  for (int k = 0; k < 1000; ++k) drawn.insert(random_session());
  EXPECT_GT(drawn.size(), 950u);  // 992 expected
}

}  // namespace
}  // namespace fleetmap::store
