#include "outbox.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <map>

#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using messages::AgentStatus;
using messages::CloudRequest;
using messages::Hold;
using messages::Reach;
using testing::agent;

const AgentId kNear = agent("r2"), kFar = agent("r3"), kElsewhere = agent("r4");

/// r1, r2 and r3 share a radio, r4 is on another one.
Outbox outbox() {
  ExchangeConfig config;
  config.fleet = {kSelf, kNear, kFar, kElsewhere};
  config.on_radio = {kSelf, kNear, kFar};
  config.payload_size = [](const Message&) { return std::size_t{10}; };
  Outbox outbox(kSelf, config);
  outbox.set_receivers({kNear}, {kNear, kFar});
  return outbox;
}

/// Receivers of the messages on a link; an empty name is all.
std::multiset<AgentId> receivers(const std::vector<Outgoing>& out, Reach link) {
  std::multiset<AgentId> names;
  for (const Outgoing& one : out) {
    if (one.reach == link) names.insert(one.to.value_or(AgentId{}));
  }
  return names;
}

using Names = std::multiset<AgentId>;

TEST(Outbox, NewsGoToNearRobotsOverTheShortRangeAndToTheOthersOverTheRadio) {
  Outbox out = outbox();
  out.broadcast(Priority::kNews, testing::make_node(kSelf, 0, {}));
  EXPECT_EQ(receivers(out.take_short_range(), Reach::kShortRange), Names{AgentId{}});
  EXPECT_EQ(receivers(out.queue().take(kStart), Reach::kLongRange), Names{kFar});
}

TEST(Outbox, AbsentRobotsGetTheStatusAlone) {
  Outbox out = outbox();
  out.set_receivers({}, {kNear});
  out.broadcast(Priority::kNews, testing::make_node(kSelf, 0, {}));
  EXPECT_EQ(receivers(out.queue().take(kStart), Reach::kLongRange), Names{kNear});
  AgentStatus status;
  status.from = kSelf;
  out.broadcast(Priority::kControl, status);
  EXPECT_EQ(receivers(out.queue().take(kStart + std::chrono::seconds(10)), Reach::kLongRange),
            (Names{kNear, kFar}));
}

TEST(Outbox, OrdersGoOverBothLinks) {
  Outbox out = outbox();
  out.broadcast(Priority::kSafety, Hold{kSelf, Hold::Driving::kHeld, {}});
  EXPECT_EQ(receivers(out.take_short_range(), Reach::kShortRange), Names{AgentId{}});
  EXPECT_EQ(out.queue().take(kStart).size(), 1u);
}

TEST(Outbox, MessagesForANearRobotLeaveTheRadiosQueueAndThoseForAnotherRadioAreDropped) {
  Outbox out = outbox();
  out.queue().push(Priority::kControl, CloudRequest{kSelf, kNear, {kNear, 1}, {}});
  out.queue().push(Priority::kControl, CloudRequest{kSelf, kFar, {kFar, 1}, {}});
  out.queue().push(Priority::kControl, CloudRequest{kSelf, kElsewhere, {kElsewhere, 1}, {}});
  EXPECT_EQ(receivers(out.take_short_range(), Reach::kShortRange), Names{kNear});
  EXPECT_EQ(receivers(out.queue().take(kStart), Reach::kLongRange), Names{kFar});
}

TEST(Outbox, NewcomersAreTheRobotsThatWereNotNearBefore) {
  Outbox out = outbox();
  EXPECT_FALSE(out.set_receivers({kNear}, {}));
  EXPECT_TRUE(out.set_receivers({kNear, kFar}, {}));
  EXPECT_FALSE(out.set_receivers({kFar}, {}));
}

}  // namespace
}  // namespace fleetmap::exchange
