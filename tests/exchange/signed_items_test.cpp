#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>

#include "exchange/sim_fleet.hpp"
#include "fleetmap/fault_injection/simulated_signatures.hpp"

namespace fleetmap::exchange {
namespace {

using fault_injection::SimulatedSignatures;
using testing::agent;
using testing::events;
using testing::kThree;
using testing::make_alignment;
using testing::make_node;
using testing::SimFleet;

std::uint64_t refused(const SimFleet::Robot& robot, ItemProof proof) {
  return robot.exchange->stats().proofs[static_cast<std::size_t>(proof)];
}

/// Those of makers whose certificate is known.
class KnownMakers final : public ItemAuthenticator {
 public:
  KnownMakers(std::uint64_t secret, std::set<AgentId> known) : signatures_(secret), known(std::move(known)) {}
  Bytes fleet() const override { return signatures_.fleet(); }
  Signature sign(const graph::Node& node) const override { return signatures_.sign(node); }
  Signature sign(const graph::Alignment& alignment) const override { return signatures_.sign(alignment); }
  ItemProof verify(const graph::Node& node) const override {
    return known.contains(node.id.agent) ? signatures_.verify(node) : ItemProof::kUnknownMaker;
  }
  ItemProof verify(const graph::Alignment& alignment) const override {
    return known.contains(alignment.computed_by) ? signatures_.verify(alignment) : ItemProof::kUnknownMaker;
  }

 private:
  SimulatedSignatures signatures_;

 public:
  std::set<AgentId> known;
};

/// Three robots that hear each other and sign their items.
class SignedItems : public ::testing::Test {
 protected:
  SignedItems() {
    fleet_.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
    fleet_.authenticate(signatures_);
    for (const auto& name : kThree) fleet_.start(name, 7);
    for (const auto& name : kThree) made_.push_back(fleet_.add_node(name, 100.0 * ++east_));
    fleet_.add_alignment("r1", {made_[0].id, made_[1].id}, 0.2);
    run_to_end(3, 1);
  }
  void run_to_end(std::size_t nodes, std::size_t alignments) {
    const auto has_ended = [&] {
      return fleet_.equal_sets(nodes) && fleet_.all([&](const SimFleet::Robot& robot) {
        return robot.store->alignments().size() == alignments && robot.exchange->complete();
      });
    };
    fleet_.run_for(std::chrono::minutes(5), has_ended);
    EXPECT_TRUE(has_ended());
  }
  graph::Node invented(const char* maker, std::uint32_t seq) const {
    graph::Node node = make_node(agent(maker), seq, testing::random_bytes(500, 99), 700.0, 99);
    node.G->covariance = Matrix6d::Identity();
    node.session = session_of(seq);
    return node;
  }
  bool all_bear_signatures() const {
    return fleet_.all([&](const SimFleet::Robot& robot) {
      const auto genuine = [&](const auto& entry) {
        return signatures_->verify(entry.second) == ItemProof::kGenuine;
      };
      return std::ranges::all_of(robot.store->nodes(), genuine) &&
             std::ranges::all_of(robot.store->alignments(), genuine);
    });
  }
  bool contested(const NodeId& id) const {
    return fleet_.all([&](const SimFleet::Robot& robot) { return robot.store->is_contested(id); });
  }

  std::shared_ptr<const SimulatedSignatures> signatures_ = std::make_shared<SimulatedSignatures>(17);
  SimFleet fleet_{kThree, {.loss = 0.1}, 5, {}, testing::no_candidates};
  std::vector<graph::Node> made_;
  int east_ = 0;
};

TEST_F(SignedItems, signatures_come_with_the_items_through_third_robots_and_restarts) {
  EXPECT_TRUE(all_bear_signatures());
  // r3 gets the items of r1, who is gone, from r2, who was restarted.
  fleet_.kill("r1");
  fleet_.kill("r2");
  fleet_.kill("r3");
  fleet_.lose_store("r3");
  fleet_.start("r2", 8);
  fleet_.start("r3", 8);
  run_to_end(3, 1);
  EXPECT_TRUE(all_bear_signatures());
  EXPECT_EQ(refused(fleet_.robot("r3"), ItemProof::kGenuine), 4u) << "each is verified once";
  EXPECT_TRUE(events<ItemsAdopted>(fleet_.robot("r2")).empty());
}

TEST_F(SignedItems, held_items_are_not_verified_again) {
  const auto before = fleet_.robot("r2").exchange->stats().proofs;
  for (int k = 0; k < 5; ++k) fleet_.forge("r2", *fleet_.robot("r1").store->node(made_[0].id));
  EXPECT_EQ(fleet_.robot("r2").exchange->stats().proofs, before);
}

TEST_F(SignedItems, an_invented_item_is_refused_and_takes_no_name_from_its_maker) {
  graph::Node lie = invented("r2", fleet_.robot("r2").store->next_node_seq(7));
  fleet_.forge("r1", lie);
  lie.signature = fleet_.robot("r1").store->node(made_[0].id)->signature;
  fleet_.forge("r1", lie, agent("r3"));
  fleet_.forge("r2", lie, agent("r3"));  // to whom it pretends to be
  made_.push_back(fleet_.add_node("r2", 900.0));
  ASSERT_EQ(made_.back().id, lie.id);
  run_to_end(4, 1);
  EXPECT_FALSE(contested(lie.id));
  EXPECT_TRUE(all_bear_signatures());
  for (const auto& [name, robot] : fleet_.robots()) {
    EXPECT_TRUE(events<ItemConflict>(robot).empty()) << name.str();
    EXPECT_TRUE(events<SessionTaken>(robot).empty()) << name.str();
    EXPECT_EQ(robot.store->node(lie.id)->submap_hash, made_.back().submap_hash) << name.str();
  }
  const auto told = events<ItemRefused>(fleet_.robot("r1"));
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].proof, ItemProof::kUnsigned);
  EXPECT_FALSE(told[0].from);
  EXPECT_EQ(told[1].proof, ItemProof::kWrong);
  EXPECT_EQ(told[1].from, agent("r3")) << "who handed it over";
  EXPECT_EQ(told[1].id, lie.id) << "whose name it bears";
}

TEST_F(SignedItems, an_invented_alignment_is_refused) {
  auto lie = make_alignment(made_[0].id, made_[1].id, agent("r2"), first_seq(7), 0.01);
  lie.signature.emplace().fill(1);
  for (const auto& name : kThree) fleet_.forge(name, lie);
  fleet_.add_alignment("r2", {made_[1].id, made_[2].id}, 0.3);
  run_to_end(3, 2);
  EXPECT_EQ(fleet_.robot("r3").store->alignment({agent("r2"), first_seq(7)})->best().rmse, 0.3);
  EXPECT_EQ(events<ItemRefused>(fleet_.robot("r3")).size(), 1u);
}

TEST_F(SignedItems, altered_items_are_refused_and_genuine_ones_accepted) {
  fleet_.kill("r3");
  fleet_.lose_store("r3");
  fleet_.start("r3", 8);
  graph::Node altered = *fleet_.robot("r2").store->node(made_[0].id);
  altered.T_odom_base.translation().x() += 5.0;
  fleet_.forge("r3", altered, agent("r2"));
  EXPECT_EQ(refused(fleet_.robot("r3"), ItemProof::kWrong), 1u);
  run_to_end(3, 1);
  EXPECT_FALSE(contested(made_[0].id));
}

TEST_F(SignedItems, refusals_are_told_once_and_their_table_is_bounded) {
  for (std::uint32_t k = 0; k < 500; ++k) {
    const std::string from = "x" + std::to_string(k % 100);
    fleet_.forge("r1", invented("r2", first_seq(9) + k), agent(from));
    fleet_.forge("r1", invented("r2", first_seq(9) + k), agent(from));
  }
  EXPECT_EQ(refused(fleet_.robot("r1"), ItemProof::kUnsigned), 1000u);
  EXPECT_EQ(events<ItemRefused>(fleet_.robot("r1")).size(), 64u);
  EXPECT_EQ(fleet_.robot("r1").exchange->table_sizes().refusals, 64u);
}

/// As a robot whose disk was copied, or whose program was changed.
TEST_F(SignedItems, a_maker_that_signs_two_contents_loses_the_name_and_is_told_of) {
  graph::Node second = invented("r2", made_[1].id.seq);
  second.signature = signatures_->sign(second);
  fleet_.forge("r3", second, agent("r2"));
  ASSERT_TRUE(fleet_.robot("r3").store->is_contested(second.id));
  run_to_end(3, 1);
  EXPECT_TRUE(contested(second.id));
  for (const auto& [name, robot] : fleet_.robots()) {
    ASSERT_FALSE(events<ItemConflict>(robot).empty()) << name.str();
    EXPECT_TRUE(events<ItemConflict>(robot).front().signed_twice);
  }
  EXPECT_EQ(events<ItemConflict>(fleet_.robot("r3")).front().from, agent("r2"));
  // The evidence and its signatures survive a restart, without another look at them.
  fleet_.kill("r3");
  fleet_.start("r3", 9);
  EXPECT_TRUE(events<ItemsAdopted>(fleet_.robot("r3")).empty());
  const auto names = fleet_.robot("r3").store->contested_nodes({agent("r2"), 0, kEndOfSeqs});
  ASSERT_EQ(names.size(), 1u);
  EXPECT_EQ(signatures_->verify(*names[0].first), ItemProof::kGenuine);
  EXPECT_EQ(signatures_->verify(*names[0].second), ItemProof::kGenuine);
}

TEST_F(SignedItems, an_item_of_the_running_session_that_another_machine_signed_is_told_of) {
  graph::Node next = invented("r1", fleet_.robot("r1").store->next_node_seq(7));
  fleet_.forge("r1", next);
  EXPECT_TRUE(events<ItemConflict>(fleet_.robot("r1")).empty());
  next.signature = signatures_->sign(next);
  fleet_.forge("r1", next);
  ASSERT_EQ(events<ItemConflict>(fleet_.robot("r1")).size(), 1u);
  EXPECT_TRUE(events<ItemConflict>(fleet_.robot("r1"))[0].signed_twice);
}

TEST_F(SignedItems, a_message_in_the_name_of_another_member_is_told_of_and_has_no_effect) {
  auto& r1 = fleet_.robot("r1");
  const auto before = r1.exchange->statuses().at(agent("r2"));
  messages::AgentStatus status = before;
  status.nodes = 500;
  status.stamp += std::chrono::seconds(1);
  messages::MissionReport report;
  report.from = agent("r2");
  fleet_.forge("r1", status, agent("r3"));
  fleet_.forge("r1", report, agent("r3"));
  fleet_.forge("r1", messages::Digest{agent("r2"), {{agent("r2"), 9, 500}}, {}}, agent("r3"));
  EXPECT_EQ(r1.exchange->statuses().at(agent("r2")).nodes, before.nodes);
  EXPECT_TRUE(events<MissionHeard>(r1).empty());
  EXPECT_TRUE(r1.exchange->complete()) << "nothing is waited for";
  EXPECT_EQ(r1.exchange->stats().misbehaved.at(agent("r3")), 3u);
  fleet_.forge("r1", status, agent("r2"));
  EXPECT_EQ(r1.exchange->statuses().at(agent("r2")).nodes, 500u) << "so the link's sender decided";
}

TEST_F(SignedItems, items_of_a_maker_whose_certificate_is_to_come_are_asked_for_again) {
  fleet_.kill("r3");
  fleet_.lose_store("r3");
  const auto some = std::make_shared<KnownMakers>(17, std::set{agent("r2"), agent("r3")});
  fleet_.authenticate(some);
  fleet_.start("r3", 8);
  fleet_.run_for(std::chrono::minutes(3));
  const auto& store = *fleet_.robot("r3").store;
  EXPECT_EQ(store.nodes().size(), 2u);
  EXPECT_FALSE(fleet_.robot("r2").exchange->fleet_caught_up());
  ASSERT_EQ(events<ItemRefused>(fleet_.robot("r3")).size(), 2u) << "of r1 alone: by r1, and by r2";
  EXPECT_EQ(events<ItemRefused>(fleet_.robot("r3"))[0].proof, ItemProof::kUnknownMaker);
  some->known.insert(agent("r1"));
  run_to_end(3, 1);
}

TEST(SignedItemsLater, a_fleet_that_gets_keys_signs_its_items_and_drops_what_nobody_signs) {
  SimFleet fleet(kThree, {.loss = 0.1}, 5, {}, testing::no_candidates);
  fleet.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
  for (const auto& name : kThree) fleet.start(name, 7);
  std::vector<graph::Node> made;
  for (int k = 0; k < 6; ++k)
    made.push_back(fleet.add_node(kThree[static_cast<std::size_t>(k) % 3], 100.0 * k));
  fleet.add_alignment("r1", {made[0].id, made[1].id}, 0.2);
  fleet.run_for(std::chrono::minutes(1), [&] { return fleet.equal_sets(6); });
  ASSERT_TRUE(fleet.equal_sets(6));
  // A signature that nobody can verify is not kept, and one forged item contests a name.
  graph::Node forged = make_node(agent("r2"), made[1].id.seq, testing::random_bytes(500, 99), 700.0, 99);
  forged.signature.emplace().fill(3);
  fleet.forge("r3", forged);
  fleet.run_for(std::chrono::minutes(1));
  ASSERT_TRUE(fleet.robot("r1").store->is_contested(made[1].id));
  for (const auto& name : kThree) fleet.kill(name);

  const auto signatures = std::make_shared<SimulatedSignatures>(17);
  fleet.authenticate(signatures);
  for (const auto& name : kThree) fleet.start(name, 8);
  fleet.run_for(std::chrono::minutes(5), [&] { return fleet.equal_sets(6); });
  EXPECT_TRUE(fleet.equal_sets(6));
  for (const auto& [name, robot] : fleet.robots()) {
    const auto told = events<ItemsAdopted>(robot);
    ASSERT_EQ(told.size(), 1u) << name.str();
    EXPECT_EQ(told[0].items.signed_own, name.str() == "r1" ? 3u : name.str() == "r2" ? 3u : 2u);
    for (const auto& [id, node] : robot.store->nodes())
      EXPECT_EQ(signatures->verify(node), ItemProof::kGenuine) << to_string(id);
    EXPECT_EQ(robot.store->contested_nodes({agent("r2"), 0, kEndOfSeqs}).size(), 0u);
  }
  // Keys of another fleet: the same again.
  for (const auto& name : kThree) fleet.kill(name);
  fleet.authenticate(std::make_shared<SimulatedSignatures>(18));
  for (const auto& name : kThree) fleet.start(name, 9);
  fleet.run_for(std::chrono::minutes(5), [&] { return fleet.equal_sets(6); });
  EXPECT_TRUE(fleet.equal_sets(6));
}

}  // namespace
}  // namespace fleetmap::exchange
