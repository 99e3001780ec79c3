#include "fleetmap/exchange/exchange_config.hpp"

#include <gtest/gtest.h>

#include <string>

#include "store/items.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;

ExchangeConfig config_of(int robots) {
  ExchangeConfig config;
  for (int k = 1; k <= robots; ++k) config.fleet.push_back(agent("r" + std::to_string(k)));
  config.payload_size = [](const Message&) { return std::size_t{10}; };
  return config;
}

/// The reason for which a configuration of r1 is refused; empty if it is accepted.
std::string problem(const ExchangeConfig& config) {
  const Status status = config.validate(agent("r1"));
  return status ? "" : status.error().message;
}

TEST(ExchangeConfig, TheFleetNamesThisRobotAndEveryOtherOnce) {
  EXPECT_EQ(problem(config_of(3)), "");
  ExchangeConfig config = config_of(3);
  config.fleet.push_back(agent("r2"));
  EXPECT_NE(problem(config).find("every agent once"), std::string::npos);
  config = config_of(3);
  config.fleet.erase(config.fleet.begin());
  EXPECT_NE(problem(config).find("this agent"), std::string::npos);
}

TEST(ExchangeConfig, TheRobotsOnTheRadioAreOfTheFleetWithThisOne) {
  ExchangeConfig config = config_of(3);
  config.on_radio = {agent("r1"), agent("r2")};
  EXPECT_EQ(problem(config), "");
  config.on_radio = {agent("r1"), agent("x")};
  EXPECT_NE(problem(config).find("not in the fleet"), std::string::npos);
  config.on_radio = {agent("r2")};
  EXPECT_NE(problem(config).find("long_range.robots"), std::string::npos);
}

TEST(ExchangeConfig, PeriodsAreStretchedInProportionToTheSquareOfALargeFleet) {
  const Duration period = config_of(1).status_period;
  EXPECT_EQ(for_fleet(config_of(1)).status_period, period);
  EXPECT_EQ(for_fleet(config_of(5)).status_period, period);
  EXPECT_NEAR(to_seconds(for_fleet(config_of(10)).status_period) / to_seconds(period),
              10.0 * 9.0 / (5.0 * 4.0), 1e-6);
  ExchangeConfig multicast = config_of(10);
  multicast.long_range.multicast = true;
  EXPECT_EQ(for_fleet(multicast).status_period, period) << "one datagram reaches all";
  ExchangeConfig slow = config_of(5);
  slow.long_range.fleet_bytes_per_second /= 2.0;
  EXPECT_NEAR(to_seconds(for_fleet(slow).status_period) / to_seconds(period), 2.0, 1e-6);
}

TEST(ExchangeConfig, OnlyTheRobotsOnTheSameRadioStretchThePeriods) {
  ExchangeConfig config = config_of(10);
  config.on_radio = {agent("r1"), agent("r2")};
  EXPECT_EQ(for_fleet(config).status_period, config.status_period);
  EXPECT_EQ(for_fleet(config_of(3)).on_radio, config_of(3).fleet);
}

}  // namespace
}  // namespace fleetmap::exchange
