#include "fleetmap/bus/dds_bus_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::bus {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;

DdsBusConfig valid() {
  DdsBusConfig config;
  config.agent = AgentId::parse("r1").value();
  return config;
}

TEST(DdsBusConfig, TheRobotHasAName) {
  EXPECT_TRUE(valid().validate());
  expect_refused(
      valid(), [](DdsBusConfig& c) { c.agent = {}; }, "agent");
}

TEST(DdsBusConfig, LinksOfOneRobotHaveDomainsOfTheirOwn) {
  expect_refused(
      valid(), [](DdsBusConfig& c) { c.long_range.domain = c.onboard.domain; }, "long_range.domain");
  expect_refused(
      valid(), [](DdsBusConfig& c) { c.short_range.domain = c.onboard.domain; }, "short_range.domain");
  expect_refused(
      valid(), [](DdsBusConfig& c) { c.short_range.domain = c.long_range.domain; },
      "short_range.domain must differ from long_range");
  DdsBusConfig off = valid();
  off.short_range.domain = off.long_range.domain;
  off.long_range.enabled = false;
  EXPECT_TRUE(off.validate()) << "a link that is off uses no domain";
}

TEST(DdsBusConfig, EachLinkThatIsOnIsChecked) {
  expect_refused(
      valid(), [](DdsBusConfig& c) { c.onboard.domain = 231; }, "onboard.domain");
  expect_refused(
      valid(), [](DdsBusConfig& c) { c.long_range.queue_messages = 0; }, "long_range.queue_messages");
  expect_refused(
      valid(), [](DdsBusConfig& c) { c.short_range.queue_bytes = 0; }, "short_range.queue_bytes");
  DdsBusConfig off = valid();
  off.short_range.queue_bytes = 0;
  off.short_range.enabled = false;
  EXPECT_TRUE(off.validate());
}

TEST(DdsBusConfig, MulticastIsForRadios) {
  DdsBusConfig radios = valid();
  radios.long_range.multicast = radios.short_range.multicast = true;
  EXPECT_TRUE(radios.validate());
  expect_refused(
      valid(), [](DdsBusConfig& c) { c.onboard.multicast = true; }, "onboard.multicast");
}

TEST(DdsBusConfig, EachLinkHasItsSettings) {
  const DdsBusConfig config = valid();
  EXPECT_EQ(&config_of(config, Link::kOnboard), &config.onboard);
  EXPECT_EQ(&config_of(config, Link::kLongRange), &config.long_range);
  EXPECT_EQ(&config_of(config, Link::kShortRange), &config.short_range);
}

}  // namespace
}  // namespace fleetmap::bus
