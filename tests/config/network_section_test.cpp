#include "network_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "section_problems.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct NetworkReading {
  bus::LocalNetworkConfig network;
  std::vector<RadioBlackout> blackouts;
  std::string problems;
};

NetworkReading network_of(const std::string& yaml) {
  NetworkReading result;
  result.problems =
      problems_of(yaml, [&](Section& top) { read_network(top, result.network, result.blackouts); });
  return result;
}

TEST(NetworkSection, ReadsBothRadios) {
  const NetworkReading r = network_of(
      "network: {seed: 9, long_range: {rate_kbit_s: 64, delay: 0.05, loss: 0.1},\n"
      "  short_range: {rate_kbit_s: 8000, max_range: 60}}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.network.seed, 9u);
  EXPECT_DOUBLE_EQ(r.network.long_range.rate_bit_s, 64e3);
  EXPECT_EQ(r.network.long_range.delay, std::chrono::milliseconds(50));
  EXPECT_EQ(r.network.long_range.loss, 0.1);
  EXPECT_DOUBLE_EQ(r.network.short_range.rate_bit_s, 8e6);
  EXPECT_EQ(r.network.short_range.max_range, 60.0);
  EXPECT_TRUE(r.blackouts.empty());
}

TEST(NetworkSection, ReadsBlackoutsOfALinkOrOfOneRobot) {
  const NetworkReading r = network_of(
      "network:\n  blackouts:\n    - {link: long_range, from: 10, until: 20}\n"
      "    - {link: short_range, from: 0, until: 5, agent: r2}\n");
  EXPECT_EQ(r.problems, "");
  ASSERT_EQ(r.blackouts.size(), 2u);
  EXPECT_EQ(r.blackouts[0].link, bus::Link::kLongRange);
  EXPECT_EQ(r.blackouts[0].from, 10.0);
  EXPECT_EQ(r.blackouts[0].until, 20.0);
  EXPECT_FALSE(r.blackouts[0].agent);
  EXPECT_EQ(r.blackouts[1].link, bus::Link::kShortRange);
  ASSERT_TRUE(r.blackouts[1].agent);
  EXPECT_EQ(r.blackouts[1].agent->str(), "r2");
}

TEST(NetworkSection, ProblemsNameTheKeyAndItsLine) {
  const auto blackout = [](const std::string& keys) {
    return network_of("network:\n  blackouts:\n    - {" + keys + "}\n").problems;
  };
  EXPECT_THAT(blackout("link: onboard, from: 0, until: 1"),
              HasSubstr("robot.yaml:3: network.blackouts[0].link: "));
  EXPECT_THAT(blackout("link: long_range, from: 5, until: 5"), HasSubstr("expected 0 <= from < until"));
  EXPECT_THAT(blackout("link: long_range, from: -1, until: 5"), HasSubstr("expected 0 <= from < until"));
  EXPECT_THAT(blackout("link: long_range, from: 0, until: 5, agent: 'a b'"),
              HasSubstr("blackouts[0].agent: "));
  EXPECT_THAT(network_of("network:\n  long_range: {loss: 1}\n").problems,
              HasSubstr("loss must be in [0, 1)"));
}

}  // namespace
}  // namespace fleetmap::config
