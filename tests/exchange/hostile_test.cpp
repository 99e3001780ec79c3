#include <gtest/gtest.h>

#include <algorithm>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::Digest;
using messages::SubmapChunk;
using messages::SubmapDigest;
using testing::agent;
using testing::events;
using testing::kThree;
using testing::make_alignment;
using testing::make_node;
using testing::SimFleet;

/// Every robot has a node with this place and submap, under whatever name.
bool all_have(const SimFleet& fleet, const graph::Node& node) {
  return fleet.all([&](const SimFleet::Robot& robot) {
    return std::ranges::any_of(robot.store->nodes(), [&](const auto& entry) {
      const graph::Node& held = entry.second;
      return held.id.agent == node.id.agent && held.submap_hash == node.submap_hash &&
             held.G->position == node.G->position;
    });
  });
}

/// Three robots that hear each other on both links and have made three nodes each.
class Hostile : public ::testing::Test {
 protected:
  Hostile() {
    fleet_.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
    for (const auto& name : kThree) fleet_.start(name, 7);
    for (int k = 0; k < 3; ++k) add_nodes();
    fleet_.run_for(std::chrono::seconds(30), [&] { return fleet_.equal_sets(9); });
  }
  void add_nodes() {
    for (const auto& name : kThree) made_.push_back(fleet_.add_node(name, 100.0 * ++east_));
  }
  graph::Node forged(const char* maker, std::uint32_t seq, std::uint32_t seed = 99) {
    graph::Node node = make_node(agent(maker), seq, testing::random_bytes(500, seed), 7.0 * seed, seed);
    node.G->covariance = Matrix6d::Identity();
    node.session = session_of(seq);
    return node;
  }
  void run_to_end(Duration time = std::chrono::minutes(5)) {
    fleet_.run_for(time, [&] { return fleet_.equal_contents() && all_made_are_held() && all_complete(); });
  }
  bool all_made_are_held() const {
    return std::ranges::all_of(made_, [&](const graph::Node& node) { return all_have(fleet_, node); });
  }
  bool all_complete() const {
    return fleet_.all([](const SimFleet::Robot& robot) { return robot.exchange->complete(); });
  }
  void expect_all_is_well() {
    EXPECT_TRUE(fleet_.equal_contents());
    EXPECT_TRUE(all_made_are_held());
    EXPECT_TRUE(all_complete());
  }
  SimFleet fleet_{kThree, {.loss = 0.1}, 5, {}, testing::no_candidates};
  std::vector<graph::Node> made_;
  int east_ = 0;
};

TEST_F(Hostile, a_forged_own_node_of_a_huge_number_stops_nobody) {
  const auto node = forged("r1", first_seq(7) + 60'000);
  for (const auto& name : kThree) fleet_.forge(name, node);
  fleet_.run_for(std::chrono::seconds(30));
  for (int k = 0; k < 3; ++k) add_nodes();
  run_to_end();
  expect_all_is_well();
  EXPECT_FALSE(events<SessionTaken>(fleet_.robot("r1")).empty()) << "it numbers from elsewhere now";
  EXPECT_EQ(events<ItemConflict>(fleet_.robot("r1")).front().id, node.id);
  for (const auto& name : kThree) fleet_.kill(name);
  for (const auto& name : kThree) fleet_.start(name, 8);
  add_nodes();
  run_to_end();
  expect_all_is_well();
}

TEST_F(Hostile, forged_nodes_of_the_last_sessions_stop_no_start) {
  for (const auto& name : kThree) {
    fleet_.forge(name, forged("r1", first_seq(255)));
    fleet_.forge(name, forged("r1", kEndOfSeqs - 1));
    fleet_.forge(name, forged("r1", UINT32_MAX));
  }
  run_to_end();
  fleet_.kill("r1");
  fleet_.start("r1", 9);
  add_nodes();
  run_to_end();
  expect_all_is_well();
}

TEST_F(Hostile, a_forged_alignment_of_the_largest_number_ends_no_alignments) {
  const NodeId i = made_[0].id, j = made_[1].id;
  for (const auto& name : kThree) {
    fleet_.forge(name, make_alignment(i, j, agent("r1"), first_seq(7) + kItemsPerSession - 1));
    fleet_.forge(name, make_alignment(i, j, agent("r1"), kEndOfSeqs - 1));
  }
  fleet_.run_for(std::chrono::seconds(30));
  fleet_.add_alignment("r1", {i, j}, 0.1);
  run_to_end();
  expect_all_is_well();
  EXPECT_EQ(fleet_.robot("r3").store->alignments().size(), 3u);
}

TEST_F(Hostile, a_forged_next_node_that_comes_first_costs_the_name_and_not_the_node) {
  const auto node = forged("r2", fleet_.robot("r2").store->next_node_seq(7));
  fleet_.forge("r1", node);
  fleet_.forge("r3", node);
  add_nodes();
  ASSERT_EQ(made_[10].id, node.id) << "r2 has not heard of it";
  run_to_end();
  expect_all_is_well();
  EXPECT_FALSE(all_have(fleet_, node)) << "nobody maps by the forged one";
  for (const auto& [name, robot] : fleet_.robots()) {
    EXPECT_TRUE(robot.store->is_contested(node.id)) << name.str();
    EXPECT_FALSE(robot.store->node(node.id)) << name.str();
    EXPECT_EQ(events<ItemConflict>(robot).front().id, node.id) << name.str();
  }
  const auto& store = *fleet_.robot("r3").store;
  const auto joined = std::ranges::find_if(store.alignments(), [](const auto& entry) {
    return entry.second.i.agent == agent("r2") && entry.second.j.agent == agent("r2");
  });
  ASSERT_NE(joined, store.alignments().end()) << "the odometry joins the node to the one before";
  EXPECT_EQ(joined->second.i, made_[7].id);
  const Pose T_before_named = made_[7].T_odom_base.inverse() * made_[10].T_odom_base;
  EXPECT_LT((joined->second.best().T_i_j.matrix() - T_before_named.matrix()).norm(), 1e-9);
}

/// Digests of names alone would show nothing.
TEST_F(Hostile, robots_that_hold_other_contents_under_one_name_find_out) {
  for (int k = 0; k < 60; ++k) made_.push_back(fleet_.add_node("r2", 10'000.0 + 20.0 * k, 40));
  run_to_end();
  ASSERT_TRUE(all_made_are_held());
  // r3 loses its store, and gets a forged item before the genuine ones.
  fleet_.kill("r3");
  fleet_.lose_store("r3");
  fleet_.start("r3", 8);
  const auto node = forged("r2", made_[40].id.seq);
  fleet_.forge("r3", node);
  run_to_end();
  expect_all_is_well();
  EXPECT_FALSE(all_have(fleet_, node));
  EXPECT_TRUE(fleet_.robot("r2").store->is_contested(node.id));
}

TEST_F(Hostile, a_forged_alignment_that_comes_first_costs_its_name) {
  const auto lie = make_alignment(made_[0].id, made_[1].id, agent("r2"), first_seq(7), 0.01);
  fleet_.forge("r1", lie);
  fleet_.forge("r3", lie);
  fleet_.add_alignment("r2", {made_[1].id, made_[0].id}, 0.3);
  run_to_end();
  expect_all_is_well();
  for (const auto& [name, robot] : fleet_.robots()) {
    ASSERT_EQ(robot.store->alignments().size(), 1u) << name.str();
    EXPECT_EQ(robot.store->alignments().begin()->second.best().rmse, 0.3) << name.str();
  }
}

TEST_F(Hostile, a_node_that_is_named_anew_is_not_named_again_after_a_restart) {
  fleet_.forge("r1", forged("r2", made_[1].id.seq));
  run_to_end();
  expect_all_is_well();
  const std::size_t nodes = fleet_.robot("r2").store->nodes().size();
  EXPECT_EQ(nodes, 9u);
  for (int k = 0; k < 2; ++k) {
    fleet_.kill("r2");
    fleet_.start("r2", static_cast<std::uint16_t>(20 + k));
    run_to_end();
  }
  expect_all_is_well();
  EXPECT_EQ(fleet_.robot("r2").store->nodes().size(), nodes);
}

TEST_F(Hostile, a_forged_digest_lasts_until_the_next_genuine_one) {
  run_to_end();
  ASSERT_TRUE(all_complete());
  const Digest lie{agent("r2"), {{agent("r3"), first_seq(40), first_seq(40) + 5'000}}, {}, {1}, {}};
  fleet_.forge("r1", lie);
  EXPECT_FALSE(fleet_.robot("r1").exchange->complete());
  fleet_.run_for(std::chrono::seconds(40), [&] { return all_complete(); });
  EXPECT_TRUE(all_complete());
  EXPECT_TRUE(events<OfferUndelivered>(fleet_.robot("r1")).empty());
}

TEST_F(Hostile, false_offers_are_reported_and_not_waited_for) {
  run_to_end();
  const NodeId first = made_[0].id;
  const Digest lie{
      agent("r2"),
      {{agent("r1"), first_seq(5), first_seq(5) + 50'000}, {agent("r3"), first_seq(40), first_seq(41)}},
      {{agent("r3"), first_seq(40), first_seq(40) + 9}},
      {1, 1},
      {1}};
  fleet_.kill("r2");  // the liar speaks in its name
  for (int k = 0; k < 60; ++k) {
    for (const char* name : {"r1", "r3"}) fleet_.forge(name, lie);
    fleet_.run_for(std::chrono::seconds(4));
  }
  EXPECT_TRUE(all_complete());
  ASSERT_EQ(events<OfferUndelivered>(fleet_.robot("r1")).size(), 1u);
  EXPECT_EQ(events<OfferUndelivered>(fleet_.robot("r1"))[0].peer, agent("r2"));
  EXPECT_EQ(events<OfferUndelivered>(fleet_.robot("r1"))[0].nodes, 50'000u + 65'536u);
  EXPECT_EQ(events<OfferUndelivered>(fleet_.robot("r1"))[0].alignments, 9u);
  // It is not deaf to what is delivered after all, nor to others.
  fleet_.forge("r1", forged("r3", first_seq(40) + 3));
  EXPECT_TRUE(fleet_.robot("r1").store->node({agent("r3"), first_seq(40) + 3}));
  fleet_.forge("r1", lie);
  EXPECT_FALSE(fleet_.robot("r1").exchange->complete()) << "who delivers is waited for again";
  EXPECT_TRUE(fleet_.robot("r1").store->node(first));
}

TEST_F(Hostile, false_offers_do_not_delay_other_requests) {
  run_to_end();
  fleet_.reachable = [](const AgentId& from, const AgentId&, Reach) { return from.str() != "r3"; };
  made_.push_back(fleet_.add_node("r3", 5'000.0));
  // Before it in the order of names.
  Digest lie{agent("r3"), {}, {}, {}, {}};
  for (std::uint16_t session = 100; session < 120; ++session) {
    lie.nodes.push_back({agent("r1"), first_seq(session), first_seq(session) + 500});
    lie.node_prints.push_back(1);
  }
  lie.nodes.push_back({agent("r3"), first_seq(7), made_.back().id.seq + 1});
  lie.node_prints.push_back(1);
  const auto held = [&] { return fleet_.robot("r1").store->node(made_.back().id) != nullptr; };
  fleet_.run_for(std::chrono::seconds(20));
  ASSERT_FALSE(held());
  fleet_.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
  for (int k = 0; k < 200 && !held(); ++k) {
    fleet_.forge("r1", lie);
    fleet_.run_for(std::chrono::seconds(1));
  }
  EXPECT_TRUE(held());
}

TEST_F(Hostile, a_forged_node_whose_submap_nobody_has_is_not_waited_for) {
  for (const auto& name : kThree) fleet_.forge(name, forged("r3", first_seq(50)));
  EXPECT_FALSE(all_complete());
  fleet_.run_for(std::chrono::seconds(20));
  EXPECT_FALSE(all_complete()) << "its maker may just have made it";
  run_to_end();
  expect_all_is_well();
}

TEST_F(Hostile, digests_of_submaps_name_the_fleets_own_and_plausible_ranges_alone) {
  run_to_end();
  const auto even = [&] { return fleet_.robot("r1").exchange->in_sync_with(fleet_.now()).size(); };
  fleet_.run_for(std::chrono::seconds(5), [&] { return even() == 2u; });
  ASSERT_EQ(even(), 2u);
  const auto before = fleet_.robot("r1").exchange->stats();
  fleet_.forge("r1", SubmapDigest{agent("r2"),
                                  {{agent("x"), 0, 5}, {agent("y"), 0, 5}, {agent("r3"), 0, kEndOfSeqs}},
                                  {agent("r1")}});
  const auto after = fleet_.robot("r1").exchange->stats();
  EXPECT_EQ(after.strangers - before.strangers, 2u);
  EXPECT_EQ(after.submap_receiver.hostile - before.submap_receiver.hostile, 1u);
  fleet_.forge("r1",
               SubmapDigest{agent("r2"), {{agent("r3"), first_seq(60), first_seq(60) + 9}}, {agent("r1")}});
  EXPECT_EQ(even(), 1u);
  fleet_.run_for(std::chrono::seconds(5), [&] { return even() == 2u; });
  EXPECT_EQ(even(), 2u) << "the next digest says what it holds";
}

TEST_F(Hostile, chunks_nobody_asked_for_do_not_reach_the_disk) {
  run_to_end();
  fleet_.reachable = [](const AgentId& from, const AgentId&, Reach) { return from.str() != "r3"; };
  const graph::Node node = fleet_.add_node("r3", 5'000.0, 400 * store::Store::kChunkBytes);
  fleet_.forge("r1", node);
  const Bytes rubbish = testing::random_bytes(store::Store::kChunkBytes, 1);
  const auto chunk = [&](const char* from, std::uint32_t index) {
    return SubmapChunk{agent(from),       agent("r1"), node.id, index * store::Store::kChunkBytes,
                       node.submap_bytes, rubbish};
  };
  const auto& store = *fleet_.robot("r1").store;
  fleet_.forge("r1", chunk("r3", 0));
  EXPECT_EQ(store.missing_chunks(node.id).size(), 400u) << "nothing of it was asked for";
  // Once r3 says that it has the submap, some chunks are asked of it: no more than the window has room for.
  fleet_.forge("r1", SubmapDigest{agent("r3"), {{agent("r3"), node.id.seq, node.id.seq + 1}}, {agent("r1")}});
  fleet_.run_for(std::chrono::milliseconds(20));
  fleet_.forge("r1", chunk("r3", 399));
  fleet_.forge("r1", chunk("r2", 0));
  EXPECT_EQ(store.missing_chunks(node.id).size(), 400u);
  EXPECT_EQ(fleet_.robot("r1").exchange->stats().submap_receiver.unasked, 3u);
  fleet_.forge("r1", chunk("r3", 0));
  EXPECT_EQ(store.missing_chunks(node.id).size(), 399u) << "this one was asked for";
}

/// A fleet's oldest maps may be lost with their robots.
TEST(HostileSubmaps, thousands_that_nobody_has_do_not_keep_live_ones_from_being_asked_for) {
  SimFleet fleet({"r1", "r2", "r3"}, {}, 5, {}, testing::no_candidates);
  fleet.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
  fleet.start("r1");
  fleet.start("r3");
  const Bytes gone = testing::random_bytes(100, 1);
  for (std::uint32_t seq = 0; seq < 4200; ++seq)
    ASSERT_TRUE(fleet.robot("r1").store->put_node(make_node(agent("r2"), seq, gone, 500.0 + seq)));
  const graph::Node live = fleet.add_node("r3", 0.0);
  fleet.run_for(std::chrono::seconds(60), [&] { return fleet.robot("r1").store->has_submap(live.id); });
  EXPECT_TRUE(fleet.robot("r1").store->has_submap(live.id));
}

TEST_F(Hostile, senders_of_forged_or_invalid_messages_are_named) {
  using Kind = SenderMisbehaved::Kind;
  auto& r1 = fleet_.robot("r1");
  messages::AgentStatus status;
  messages::MissionReport report;
  status.from = report.from = agent("r2");
  fleet_.forge("r1", status, agent("r2"));
  fleet_.forge("r1", forged("r2", first_seq(60)), agent("r3"));  // items go through third robots
  EXPECT_TRUE(events<SenderMisbehaved>(r1).empty());
  for (int k = 0; k < 5; ++k) fleet_.forge("r1", report, agent("r3"));
  fleet_.forge("r1", Digest{agent("r3"), {{agent("r2"), 9, 5}}, {}}, agent("r3"));
  fleet_.forge("r1", SubmapChunk{agent("r2"), agent("r1"), made_.front().id, 0, 4000, Bytes(4000)});
  const auto misbehaved = events<SenderMisbehaved>(r1);
  ASSERT_EQ(misbehaved.size(), 3u);
  const auto is = [&](const SenderMisbehaved& one, const char* name, std::optional<AgentId> from, Kind kind) {
    return one.name == agent(name) && one.from == from && one.kind == kind;
  };
  EXPECT_TRUE(is(misbehaved[0], "r2", agent("r3"), Kind::kForeignName));
  EXPECT_TRUE(is(misbehaved[1], "r3", agent("r3"), Kind::kDigest));
  EXPECT_TRUE(is(misbehaved[2], "r2", std::nullopt, Kind::kSubmap));
  const std::map<AgentId, std::uint64_t> counts{{agent("r2"), 1}, {agent("r3"), 6}};
  EXPECT_EQ(r1.exchange->stats().misbehaved, counts);
}

}  // namespace
}  // namespace fleetmap::exchange
