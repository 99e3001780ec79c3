#include "deception.hpp"

#include <gtest/gtest.h>

#include "fleetmap/fault_injection/simulated_signatures.hpp"
#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;

exchange::ExchangeConfig exchange_config() {
  exchange::ExchangeConfig config;
  config.fleet = {agent("r1"), agent("r2"), agent("r3")};
  config.authenticator = std::make_shared<SimulatedSignatures>(42);
  return config;
}

TEST(Deception, RequestsEverythingAndClaimsWhatNobodyHolds) {
  const auto fleet = exchange_config();
  const fleetmap::testing::TemporaryFolder folder;
  auto store = store::Store::open(folder / "r3.db", agent("r3"), {}).value();
  SyntheticSurvey survey(1, 3);
  for (std::size_t robot = 0; robot < 2; ++robot) {
    survey.begin_frame(robot, {});
    const NodeId id{fleet.fleet[robot], first_seq(7)};
    ASSERT_TRUE(store.put_node(survey.node(robot, id, {})->node));
    survey.on_stored(robot, id, {});
  }
  Deception deception(3, fleet);
  CompromisedRobot robot(3, agent("r3"));
  Attacker attacker(3, fleet.fleet, true);
  std::size_t requests = 0, digests = 0, of_others = 0, invented = 0, lies = 0;
  for (int k = 0; k < 2000; ++k) {
    invented += deception.invents(std::chrono::milliseconds(50));
    lies += deception.lies();
    for (const auto& one :
         deception.messages_of(robot, store, survey, attacker, std::chrono::milliseconds(50))) {
      const messages::Message& message = *one.message;
      requests += std::holds_alternative<messages::ItemRequest>(message);
      digests += std::holds_alternative<messages::Digest>(message) ||
                 std::holds_alternative<messages::SubmapDigest>(message);
      const auto* alignment = std::get_if<graph::Alignment>(&message);
      if (!alignment) continue;
      ++of_others;
      EXPECT_EQ(fleet.authenticator->verify(*alignment), exchange::ItemProof::kGenuine);
    }
  }
  EXPECT_NEAR(static_cast<double>(requests), 1000.0, 120.0);
  EXPECT_GT(digests, 10u);
  EXPECT_GT(of_others, 5u);
  EXPECT_NEAR(static_cast<double>(invented), 50.0, 25.0);
  EXPECT_NEAR(static_cast<double>(lies), 600.0, 80.0);
}

}  // namespace
}  // namespace fleetmap::fault_injection
