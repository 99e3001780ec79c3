#include "content_check.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;
using testing::make_node;
using testing::random_bytes;

/// One robot with 200 nodes of r3, and its part of the check.
struct Robot {
  explicit Robot(const char* robot) : name(agent(robot)) {
    for (std::uint32_t k = 0; k < 200; ++k)
      EXPECT_TRUE(store.put_node(make_node(kMaker, k, {}, 1.0 * k, k + 1)));
  }
  Digest digest() const {
    Digest digest{name, check.cut(store.node_set().ranges(), false), {}, {}, {}};
    for (const SeqRange& range : digest.nodes) digest.node_prints.push_back(store.node_print(range));
    return digest;
  }

  AgentId name;
  testing::TemporaryFolder folder;
  store::Store store = std::move(store::Store::open(folder / "store.db", name).value());
  ContentCheck check;
};

void contest(Robot& robot, std::uint32_t seq) {
  ASSERT_EQ(robot.store.put_node(make_node(kMaker, seq, random_bytes(9, 1), 7.0, 999)).value(),
            store::Put::kConflict);
}

TEST(ContentCheck, EqualContentsAreNeitherCutNorRequested) {
  Robot a("r1"), b("r2");
  EXPECT_FALSE(a.check.on_digest(b.digest(), a.store, kStart));
  EXPECT_EQ(a.digest().nodes.size(), 1u);
  EXPECT_FALSE(a.check.ask(a.name, b.name, kStart));
}

/// Only who holds one content can learn anything from a request.
TEST(ContentCheck, HolderOfOneContentRequestsTheOtherAfterEitherDigest) {
  for (const bool contested_hears_first : {false, true}) {
    Robot one("r1"), both("r2");
    contest(both, 77);
    std::optional<ItemRequest> request;
    Stamp now = kStart;
    for (int k = 0; k < 8 && !request; ++k, now += std::chrono::seconds(4)) {
      Robot& hears = (k % 2 == 0) == contested_hears_first ? both : one;
      Robot& sends = &hears == &one ? both : one;
      hears.check.on_digest(sends.digest(), hears.store, now);
      request = one.check.ask(one.name, both.name, now);
    }
    ASSERT_TRUE(request) << contested_hears_first;
    EXPECT_TRUE(store::SeqSet(request->nodes).contains(kMaker, 77));
    EXPECT_LE(store::SeqSet(request->nodes).size(), 8u);
    EXPECT_TRUE(request->alignments.empty());
  }
}

TEST(ContentCheck, FalseFingerprintsCauseRequestsAtGrowingIntervals) {
  Robot robot("r1");
  int requests = 0;
  for (int second = 0; second < 3600; ++second) {
    const Stamp now = kStart + std::chrono::seconds(second);
    robot.check.on_digest({agent("r2"), {{kMaker, 40, 48}}, {}, {12345}, {}}, robot.store, now);
    robot.check.expire(now);
    requests += robot.check.ask(robot.name, agent("r2"), now).has_value();
  }
  EXPECT_GE(requests, 5);
  EXPECT_LE(requests, 15);
}

TEST(ContentCheck, CutsEndWhenNothingDiffersAnyMore) {
  Robot robot("r1");
  EXPECT_TRUE(robot.check.on_digest({agent("r2"), {{kMaker, 0, 200}}, {}, {12345}, {}}, robot.store, kStart));
  EXPECT_EQ(robot.digest().nodes.size(), 8u);
  robot.check.expire(kStart + std::chrono::minutes(3));
  EXPECT_EQ(robot.digest().nodes.size(), 1u);
}

}  // namespace
}  // namespace fleetmap::exchange
