#include "attacker.hpp"

#include <gtest/gtest.h>

#include <set>

#include "fault_injection/three_robots.hpp"
#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;
using fleetmap::testing::make_node;

/// An attacker that has overheard nodes of session 7, one with a submap of several chunks.
Attacker listening() {
  Attacker attacker(1, kFleet, false);
  graph::Node node = make_node(agent("r2"), first_seq(7) + 3, {});
  for (int k = 0; k < 200; ++k) {
    node.submap_bytes = k % 2 == 0 ? 500 : 3 * store::Store::kChunkBytes;
    attacker.overhear({Stamp{}, node.id.agent, {messages::Reach::kLongRange, {}, node}, 100});
  }
  return attacker;
}

TEST(Attacker, ForgesItemsDigestsAndChunksInTheNamesOfTheFleet) {
  Attacker attacker = listening();
  std::set<std::size_t> kinds;
  bool next = false, last = false, largest = false, invented = false;
  for (int k = 0; k < 2000; ++k) {
    const auto forged = attacker.forged();
    if (!forged) continue;
    const messages::Message& message = *forged->message;
    kinds.insert(message.index());
    if (const auto* node = std::get_if<graph::Node>(&message)) {
      next |= node->id == NodeId{agent("r2"), first_seq(7) + 4};
      last |= node->id == NodeId{agent("r2"), first_seq(8) - 1};
      largest |= node->id.seq == kEndOfSeqs - 1;
    }
    if (const auto* digest = std::get_if<messages::SubmapDigest>(&message))
      invented |= digest->submaps.front().agent.str().front() == 'x';
    if (const auto* chunk = std::get_if<messages::SubmapChunk>(&message)) {
      EXPECT_EQ(chunk->total_bytes, 3 * store::Store::kChunkBytes);
    }
  }
  EXPECT_EQ(kinds.size(), 5u) << "nodes, alignments, both kinds of digests, chunks";
  EXPECT_TRUE(next && last && largest && invented);
}

TEST(Attacker, ClaimsOfAMemberAreDigestsAndChunks) {
  Attacker attacker = listening();
  std::set<std::size_t> kinds;
  for (int k = 0; k < 200; ++k)
    if (const auto claim = attacker.forged_claim()) kinds.insert(claim->message->index());
  EXPECT_EQ(kinds, (std::set{messages::Message(messages::Digest{}).index(),
                             messages::Message(messages::SubmapDigest{}).index(),
                             messages::Message(messages::SubmapChunk{}).index()}));
}

TEST(Attacker, ALiarOffersWhatNobodyMade) {
  Attacker attacker = listening();
  const auto lie = attacker.lie(messages::Digest{agent("r1"), {{agent("r1"), 0, 3}}, {}}, agent("r1"));
  ASSERT_EQ(std::get<messages::Digest>(lie).nodes.size(), kFleet.size());
  EXPECT_EQ(std::get<messages::Digest>(lie).nodes[2].end, kEndOfSeqs);
}

}  // namespace
}  // namespace fleetmap::fault_injection
