#include "exchange_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "section_problems.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

AgentReading exchange_of(const std::string& yaml) { return agent_of(yaml, read_exchange); }

TEST(ExchangeSections, ReadsBothLinksInTheUnitsOfTheirKeys) {
  const AgentReading r = exchange_of(
      "long_range: {budget_kbit_s: 80, robots: [r1, r3], burst_seconds: 0.5, status_period: 7,\n"
      "  digest_min_period: 2.5, digest_max_period: 40}\n"
      "short_range: {rate_mbit_s: 6, window_bytes: 65536, peer_timeout: 9}\n");
  EXPECT_EQ(r.problems, "");
  const exchange::ExchangeConfig& exchange = r.agent.exchange;
  EXPECT_DOUBLE_EQ(exchange.long_range.fleet_bytes_per_second, 10'000.0);
  ASSERT_EQ(exchange.on_radio.size(), 2u);
  EXPECT_EQ(exchange.on_radio[1].str(), "r3");
  EXPECT_EQ(exchange.long_range.pace.burst_seconds, 0.5);
  EXPECT_EQ(exchange.status_period, std::chrono::seconds(7));
  EXPECT_EQ(exchange.reconcile.digest_min_period, std::chrono::milliseconds(2500));
  EXPECT_EQ(exchange.reconcile.digest_max_period, std::chrono::seconds(40));
  EXPECT_DOUBLE_EQ(exchange.submaps.bytes_per_second, 750'000.0);
  EXPECT_EQ(exchange.submaps.window.max_bytes, 65'536u);
  EXPECT_EQ(exchange.submaps.peer_timeout, std::chrono::seconds(9));
}

TEST(ExchangeSections, WithoutKeysTheDefaultsStay) {
  const AgentReading r = exchange_of("{}");
  EXPECT_EQ(r.problems, "");
  const exchange::ExchangeConfig usual;
  EXPECT_DOUBLE_EQ(r.agent.exchange.long_range.fleet_bytes_per_second,
                   usual.long_range.fleet_bytes_per_second);
  EXPECT_DOUBLE_EQ(r.agent.exchange.submaps.bytes_per_second, usual.submaps.bytes_per_second);
  EXPECT_EQ(r.agent.exchange.status_period, usual.status_period);
  EXPECT_TRUE(r.agent.exchange.on_radio.empty());
}

TEST(ExchangeSections, ProblemsNameTheKeyAndItsLine) {
  EXPECT_THAT(exchange_of("long_range:\n  burst_seconds: 11\n").problems,
              HasSubstr("robot.yaml:2: long_range.burst_seconds: "));
  EXPECT_THAT(exchange_of("long_range:\n  digest_min_period: 50\n").problems,
              HasSubstr("robot.yaml:2: long_range.digest_min_period: "));
  EXPECT_THAT(exchange_of("short_range:\n  window_bytes: 100\n").problems,
              HasSubstr("robot.yaml:2: short_range.window_bytes: "));
  EXPECT_THAT(exchange_of("long_range: {budget_kbits: 80}\n").problems,
              HasSubstr("did you mean 'budget_kbit_s'?"));
  EXPECT_THAT(exchange_of("long_range: {robots: [r1, 'a b']}\n").problems,
              HasSubstr("robot.yaml:1: long_range.robots: "));
}

}  // namespace
}  // namespace fleetmap::config
