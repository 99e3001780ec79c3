#include "monitor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fault_injection/three_robots.hpp"
#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;
using fleetmap::testing::make_node;
using fleetmap::testing::random_bytes;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MonitorTest : public ::testing::Test {
 protected:
  MonitorTest() { config_.fleet = {agent("r1"), agent("r2")}; }

  std::vector<Violation> violations() const {
    Outcome outcome;
    monitor_.fill(outcome);
    return outcome.violations;
  }
  graph::Node made(std::uint32_t seq) {
    const Bytes submap = random_bytes(500, seq + 1);
    graph::Node node = make_node(agent("r2"), seq, submap);
    node.stamp = kNow + std::chrono::seconds(seq);
    monitor_.on_made(node);
    return node;
  }
  void send(const char* from, const messages::Message& message) {
    monitor_.on_sent({kNow, agent(from), {messages::Reach::kShortRange, {}, message}, 100}, {});
  }

  /// A radio message of `bytes`, `after` a second's beginning, that robot r3 hears if `hearers` names it.
  void send_radio(const char* from, Duration after, std::size_t bytes, const std::vector<AgentId>& hearers) {
    const messages::Message hold = messages::Hold{};
    monitor_.on_sent({kNow + after, agent(from), {messages::Reach::kLongRange, {}, hold}, bytes}, hearers);
  }

  fleetmap::testing::TemporaryFolder folder_;
  store::Store store_ = store::Store::open(folder_ / "r1.db", agent("r1"), {}).value();
  exchange::ExchangeConfig config_;
  Monitor monitor_{kNow, config_, parse_invariants("all").value()};
};

TEST_F(MonitorTest, AConflictIsAViolationUnlessAnAttackerTookTheName) {
  const NodeId id{agent("r2"), 7};
  monitor_.on_forged(make_node(id.agent, id.seq, {}));
  monitor_.on_conflict(agent("r1"), {id, false, messages::Reach::kLongRange, false, {}}, kNow);
  EXPECT_THAT(violations(), IsEmpty());
  monitor_.on_conflict(agent("r1"), {id, true, messages::Reach::kLongRange, false, {}}, kNow);
  ASSERT_EQ(violations().size(), 1u) << "the alignment of this number was not forged";
  EXPECT_EQ(violations()[0].invariant, Invariant::kOwnItems);
}

TEST_F(MonitorTest, ANodeIsLostUnlessItsContentIsHeldUnderSomeName) {
  graph::Node node = made(3);
  node.id.seq = 900;
  ASSERT_TRUE(store_.put_node(node));
  monitor_.check_contents(agent("r1"), store_, kNow);
  EXPECT_THAT(violations(), IsEmpty());
  made(4);
  monitor_.check_contents(agent("r1"), store_, kNow);
  ASSERT_EQ(violations().size(), 1u);
  EXPECT_EQ(violations()[0].invariant, Invariant::kNothingLost);
  EXPECT_THAT(violations()[0].what, HasSubstr("r2/4"));
}

TEST_F(MonitorTest, ADiskThatWasLostTakesTheNodesOfItsRobotAlong) {
  made(3);
  monitor_.on_started(agent("r2"), store_, false, kNow);
  monitor_.check_contents(agent("r1"), store_, kNow);
  EXPECT_THAT(violations(), IsEmpty());
}

TEST_F(MonitorTest, AChunkOnTheDiskThatWasNeverRequestedIsAViolation) {
  constexpr std::uint32_t kChunk = store::Store::kChunkBytes;
  const Bytes submap = random_bytes(3 * kChunk, 1);
  const graph::Node node = make_node(agent("r2"), 3, submap);
  ASSERT_TRUE(store_.put_node(node));
  const auto check = [&] { monitor_.check_downloads(agent("r1"), store_, kNow); };
  send("r1", messages::SubmapRequest{agent("r1"), agent("r2"), node.id, kChunk, kChunk});
  ASSERT_TRUE(store_.put_submap_chunk(node.id, 1, ByteView(submap).subspan(kChunk, kChunk)));
  check();
  EXPECT_THAT(violations(), IsEmpty());
  ASSERT_TRUE(store_.put_submap_chunk(node.id, 0, ByteView(submap).first(kChunk)));
  check();
  ASSERT_EQ(violations().size(), 1u);
  EXPECT_EQ(violations()[0].invariant, Invariant::kBounded);
}

TEST_F(MonitorTest, FewBytesThatDecodeToManyPointsAreAViolation) {
  cloud::PointCloud cloud;
  const Bytes encoded(9000);
  cloud.points.resize(72'000);
  monitor_.on_decoded(agent("r1"), encoded, cloud, kNow);
  EXPECT_THAT(violations(), IsEmpty());
  cloud.points.resize(72'001);
  monitor_.on_decoded(agent("r1"), encoded, cloud, kNow);
  ASSERT_EQ(violations().size(), 1u);
  EXPECT_EQ(violations()[0].invariant, Invariant::kBounded);
}

TEST_F(MonitorTest, AForgedNameMayLoseItsSubmapThoughItWasAnnounced) {
  const graph::Node node = made(3);
  ASSERT_TRUE(store_.put_node(node));
  monitor_.on_forged(node);
  monitor_.check_held(agent("r2"), store_, kNow);
  EXPECT_THAT(violations(), IsEmpty());
}

using std::chrono::milliseconds;

TEST_F(MonitorTest, TheBudgetIsOfTheRobotsThatHearEachOther) {
  send_radio("r1", milliseconds(0), 12'000, {agent("r2")});
  send_radio("r3", milliseconds(1), 12'000, {agent("r4")});
  EXPECT_THAT(violations(), IsEmpty()) << "two media";
  send_radio("r2", milliseconds(2), 9'000, {agent("r1")});
  ASSERT_EQ(violations().size(), 2u) << "both hear 21 kB";
  EXPECT_EQ(violations()[0].invariant, Invariant::kBudget);
}

}  // namespace
}  // namespace fleetmap::fault_injection
