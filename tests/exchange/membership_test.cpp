#include "membership.hpp"

#include <gtest/gtest.h>

#include <string>

#include "exchange/robots.hpp"
#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;

const std::vector<AgentId> kMembers{kSelf, kPeer};

TEST(Membership, KeepsTheRangesOfMembersAndCountsTheOthers) {
  Membership members(kSelf, kMembers);
  const std::vector<SeqRange> ranges{{kPeer, 0, 3}, {kStranger, 0, 9}, {kSelf, 2, 4}};
  const std::vector<SeqRange> expected{{kPeer, 0, 3}, {kSelf, 2, 4}};
  EXPECT_EQ(members.of_members(ranges), expected);
  EXPECT_EQ(members.strangers(), 1u);
}

TEST(Membership, ReportsEachStrangerOnceAndOwnEchoesNever) {
  Membership members(kSelf, kMembers);
  EXPECT_TRUE(members.refuse_message(kStranger));
  EXPECT_FALSE(members.refuse_message(kStranger));
  EXPECT_FALSE(members.refuse_message(kSelf));
  members.refuse_item();
  EXPECT_EQ(members.strangers(), 4u);
  EXPECT_EQ(members.reported(), 1u);
}

TEST(Membership, ReportsAtMost64NamesThatAForgerInvents) {
  Membership members(kSelf, kMembers);
  std::size_t reported = 0;
  for (int k = 0; k < 100; ++k) reported += members.refuse_message(agent("x" + std::to_string(k)));
  EXPECT_EQ(reported, 64u);
  EXPECT_EQ(members.strangers(), 100u);
}

}  // namespace
}  // namespace fleetmap::exchange
