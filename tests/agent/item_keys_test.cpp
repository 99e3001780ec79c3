#include "fleetmap/agent/item_keys.hpp"

#include <gtest/gtest.h>

#include "fleetmap/agent/fleet_link.hpp"
#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/loop_closure/candidate_scheduler.hpp"
#include "support/temporary_folder.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::agent {
namespace {

using exchange::ItemProof;
using testing::FleetOfKeys;
using namespace std::chrono_literals;

std::shared_ptr<trust::Credentials> shared(trust::Credentials credentials) {
  return std::make_shared<trust::Credentials>(std::move(credentials));
}

/// As agents make it: what the wire makes of it.
graph::Node node_of(const char* maker, std::uint32_t seq) {
  graph::Node node;
  node.id = {testing::agent(maker), seq};
  node.session = session_of(seq);
  node.stamp = testing::kNow;
  node.T_odom_base = se3_exp(Vector6d{1.0, 2.0, 0.3, 0.1, -0.2, 0.7 + seq});
  node.odom_covariance = 1e-3 * Matrix6d::Identity();
  return fleet_codec::quantised(node).value();
}

class ItemKeysTest : public ::testing::Test {
 protected:
  graph::Node signed_by(const ItemKeys& keys, graph::Node node) {
    node.signature = keys.sign(node);
    return node;
  }
  FleetOfKeys fleet_;
  std::shared_ptr<trust::Credentials> r1_ = shared(fleet_.member("r1")), r2_ = shared(fleet_.member("r2"));
  ItemKeys of_r1_{r1_}, of_r2_{r2_};
};

TEST_F(ItemKeysTest, ProveTheMakerAndTheContent) {
  r2_->members = {r1_->certificate};
  graph::Node node = signed_by(of_r1_, node_of("r1", 3));
  EXPECT_EQ(of_r1_.verify(node), ItemProof::kGenuine) << "own ones come back, too";
  EXPECT_EQ(of_r2_.verify(node), ItemProof::kGenuine);
  EXPECT_EQ(of_r2_.verify(*fleet_codec::decode<graph::Node>(fleet_codec::encode(node))), ItemProof::kGenuine);
  EXPECT_EQ(of_r2_.verify(signed_by(of_r2_, node)), ItemProof::kWrong) << "in the name of another";
  graph::Node altered = node;
  altered.submap_hash[0] ^= 1;
  EXPECT_EQ(of_r2_.verify(altered), ItemProof::kWrong) << "a submap is signed with its node";
  node.signature.reset();
  EXPECT_EQ(of_r2_.verify(node), ItemProof::kUnsigned);
  graph::Alignment alignment;
  alignment.i = node.id;
  alignment.j = {testing::agent("r2"), 4};
  alignment.computed_by = testing::agent("r1");
  alignment.signature = of_r1_.sign(alignment);
  EXPECT_EQ(of_r2_.verify(alignment), ItemProof::kGenuine);
  alignment.modes.front().rmse += 0.1;
  EXPECT_EQ(of_r2_.verify(alignment), ItemProof::kWrong);
}

TEST_F(ItemKeysTest, WaitForTheCertificateThatComesWithAGreeting) {
  const graph::Node node = signed_by(of_r1_, node_of("r1", 3));
  EXPECT_EQ(of_r2_.verify(node), ItemProof::kUnknownMaker);
  r2_->learned->add(r1_->certificate);
  EXPECT_EQ(of_r2_.verify(node), ItemProof::kGenuine);
}

TEST_F(ItemKeysTest, EveryCertificateOfARobotCountsAndNoneOfAnObserver) {
  const graph::Node node = signed_by(of_r1_, node_of("r1", 3));
  const trust::Credentials renewed = fleet_.member("r1");
  r2_->members = {renewed.certificate, r1_->certificate};
  r2_->revocations.serials.insert(r1_->certificate.serial);
  EXPECT_EQ(of_r2_.verify(node), ItemProof::kGenuine) << "what it mapped stays in the map";
  const auto observer = shared(fleet_.member("o1", trust::Role::kObserver));
  r2_->members = {observer->certificate};
  EXPECT_EQ(of_r2_.verify(signed_by(ItemKeys(observer), node_of("o1", 3))), ItemProof::kUnknownMaker);
  EXPECT_NE(of_r1_.fleet(), ItemKeys(shared(FleetOfKeys().member("r1"))).fleet());
}

/// Whole links on a simulated radio: r1 makes a node, r3 hands it on, invents one in its name, and alters it.
TEST_F(ItemKeysTest, AChangedMemberHandsOnWhatIsGenuineAndInventsNothing) {
  const testing::TemporaryFolder folder;
  const auto network = bus::LocalNetwork::create({}).value();
  const auto id = [](const char* name) { return testing::agent(name); };
  bus::Bus &bus_of_r2 = network->add_robot(id("r2")), &bus_of_r3 = network->add_robot(id("r3"));
  for (const char* name : {"r2", "r3"}) network->set_position(id(name), {0.0, 0.0, 0.0});
  const trust::Credentials r3 = fleet_.member("r3");
  r2_->members = {r1_->certificate, r3.certificate};
  exchange::ExchangeConfig config;
  config.fleet = {id("r1"), id("r2"), id("r3")};
  config.payload_size = [](const messages::Message& message) { return fleet_codec::encode(message).size(); };
  config.authenticator = std::make_shared<ItemKeys>(r2_);
  auto store = store::Store::open(folder.path() / "store.db", id("r2")).value();
  loop_closure::CandidateScheduler cloud_client(store.self(), {});
  auto exchange = exchange::Exchange::make(config, store, cloud_client, network->now()).value();
  std::vector<exchange::ItemRefused> refused;
  FleetLink link(id("r2"), bus_of_r2, exchange, [&] {
    for (const exchange::Event& event : exchange.take_events()) {
      if (const auto* one = std::get_if<exchange::ItemRefused>(&event)) refused.push_back(*one);
    }
  });
  const auto say = [&](const messages::Message& message) {
    bus_of_r3.publish(fleet_codec::topic_of(message), fleet_codec::encode(message));
    network->run_until(network->now() + 1s);
  };
  const ItemKeys of_r3(shared(r3));
  const graph::Node node = signed_by(of_r1_, node_of("r1", 0));
  graph::Node altered = node;
  altered.T_odom_base.translation().x() += 3.0;
  say(altered);
  say(signed_by(of_r3, node_of("r1", 1)));
  EXPECT_TRUE(store.nodes().empty());
  ASSERT_EQ(refused.size(), 1u) << "told once of each maker and of who hands its items over";
  EXPECT_EQ(refused[0].from, id("r3"));
  EXPECT_EQ(refused[0].id.agent, id("r1"));
  EXPECT_EQ(exchange.stats().proofs[static_cast<std::size_t>(ItemProof::kWrong)], 2u);
  say(node);
  ASSERT_TRUE(store.node(node.id));
  EXPECT_EQ(store.node(node.id)->signature, node.signature);
  say(signed_by(of_r3, node_of("r3", 5)));
  EXPECT_EQ(store.nodes().size(), 2u) << "its own it may make";
}

}  // namespace
}  // namespace fleetmap::agent
