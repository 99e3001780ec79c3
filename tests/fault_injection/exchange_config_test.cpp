#include "exchange_config.hpp"

#include <gtest/gtest.h>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fault_injection {
namespace {

Scenario fleet_of(std::size_t robots) {
  Scenario scenario;
  scenario.seed = 3;
  scenario.robots = robots;
  return scenario;
}

TEST(ExchangeConfig, IsValidForEachOfTheRobots) {
  const exchange::ExchangeConfig config = exchange_config_of(fleet_of(4), false);
  ASSERT_EQ(config.fleet.size(), 4u);
  EXPECT_EQ(config.fleet.front().str(), "r1");
  EXPECT_EQ(config.fleet.back().str(), "r4");
  for (const AgentId& robot : config.fleet) {
    const Status valid = config.validate(robot);
    EXPECT_TRUE(valid) << robot.str() << ": " << valid.error().message;
  }
}

TEST(ExchangeConfig, ItemsAreSignedOnlyWhenAsked) {
  EXPECT_EQ(exchange_config_of(fleet_of(2), false).authenticator, nullptr);
  EXPECT_NE(exchange_config_of(fleet_of(2), true).authenticator, nullptr);
}

TEST(ExchangeConfig, PayloadsAreThoseOfTheWire) {
  const exchange::ExchangeConfig config = exchange_config_of(fleet_of(2), false);
  messages::ProximityMatch match;
  match.from = config.fleet[0];
  match.to = config.fleet[1];
  match.theirs = {config.fleet[1], 1};
  match.ours = {config.fleet[0], 2};
  EXPECT_EQ(config.payload_size(match), fleet_codec::encode(match).size());
}

TEST(ExchangeConfig, QueuesAreShorterThanARobots) {
  const exchange::ExchangeConfig config = exchange_config_of(fleet_of(2), false), usual;
  EXPECT_LT(config.long_range.max_small, usual.long_range.max_small);
  EXPECT_LT(config.long_range.max_backfill, usual.long_range.max_backfill);
  EXPECT_LT(config.long_range.max_fragments, usual.long_range.max_fragments);
}

}  // namespace
}  // namespace fleetmap::fault_injection
