#include "fleetmap/messages/routing.hpp"

#include <gtest/gtest.h>

namespace fleetmap::messages {
namespace {

const AgentId kR1 = *AgentId::parse("r1");
const AgentId kR2 = *AgentId::parse("r2");

TEST(Routing, SubmapsGoOverTheShortRangeAndTheRestOverTheRadio) {
  EXPECT_EQ(usual_reach(SubmapDigest{}), Reach::kShortRange);
  EXPECT_EQ(usual_reach(SubmapRequest{}), Reach::kShortRange);
  EXPECT_EQ(usual_reach(SubmapChunk{}), Reach::kShortRange);
  EXPECT_EQ(usual_reach(graph::Node{}), Reach::kLongRange);
  EXPECT_EQ(usual_reach(CloudFragment{}), Reach::kLongRange);
  EXPECT_EQ(usual_reach(Hold{}), Reach::kLongRange);
}

TEST(Routing, SenderAndRecipientAreThoseThatTheMessageNames) {
  ItemRequest request;
  request.from = kR1;
  request.to = kR2;
  EXPECT_EQ(sender_of(request), kR1);
  EXPECT_EQ(recipient_of(request), kR2);
  Digest digest;
  digest.from = kR1;
  EXPECT_EQ(sender_of(digest), kR1);
  EXPECT_EQ(recipient_of(digest), std::nullopt);
  graph::Node node;
  node.id.agent = kR1;
  EXPECT_EQ(sender_of(node), std::nullopt) << "any agent may pass it on";
}

TEST(Routing, BroadcastsExceptOrdersMayBeSentOneByOne) {
  EXPECT_TRUE(may_go_one_by_one(graph::Node{}));
  EXPECT_TRUE(may_go_one_by_one(MissionReport{}));
  EXPECT_FALSE(may_go_one_by_one(Hold{})) << "operators hear orders too";
  EXPECT_FALSE(may_go_one_by_one(ItemRequest{})) << "it has one recipient";
  EXPECT_FALSE(may_go_one_by_one(SubmapDigest{})) << "it is not for the radio";
}

}  // namespace
}  // namespace fleetmap::messages
