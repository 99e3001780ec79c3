#include "loopback_domains.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace fleetmap::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct LoopbackReading {
  LoopbackDomains domains;
  std::string problems;
};

LoopbackReading loopback_of(const std::string& yaml, const std::string& name = "fleet.yaml") {
  Document document = Document::from(YAML::Load(yaml), name);
  Section top(document, document.root(), "");
  LoopbackReading reading{read_loopback(top), ""};
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

TEST(LoopbackDomains, RobotsShareTheRadiosAndEachHasAnOnboardDomain) {
  const LoopbackDomains domains{.base = 100, .qos = "profiles"};
  std::set<std::uint32_t> used;
  for (std::size_t k = 0; k < 3; ++k) {
    const AgentId id = AgentId::parse("r" + std::to_string(k + 1)).value();
    const bus::DdsBusConfig dds = dds_of(id, k, domains);
    EXPECT_EQ(dds.agent, id);
    EXPECT_EQ(dds.qos_directory, "profiles");
    EXPECT_EQ(dds.long_range.domain, 100u);
    EXPECT_EQ(dds.short_range.domain, 101u);
    used.insert(dds.onboard.domain);
    for (const bus::DdsLinkConfig& radio : {dds.long_range, dds.short_range}) {
      EXPECT_EQ(radio.address, "127.0.0.1");
      EXPECT_THAT(radio.peers, ElementsAre("127.0.0.1"));
    }
    EXPECT_TRUE(dds.validate());
  }
  EXPECT_THAT(used, ElementsAre(102, 103, 104));
}

TEST(LoopbackDomains, BothKeysAreRead) {
  const std::string name = std::string(FLEETMAP_SOURCE_DIR) + "/fleet.yaml";
  const LoopbackReading reading = loopback_of("{dds: {base_domain: 200, qos: qos}}", name);
  EXPECT_EQ(reading.problems, "");
  EXPECT_EQ(reading.domains.base, 200u);
  EXPECT_EQ(reading.domains.qos, std::filesystem::path(FLEETMAP_SOURCE_DIR) / "qos");
  const LoopbackReading usual = loopback_of("{}");
  EXPECT_EQ(usual.problems, "");
  EXPECT_EQ(usual.domains.base, 40u);
}

TEST(LoopbackDomains, ProblemsNameTheKey) {
  EXPECT_THAT(loopback_of("{dds: {base_domain: 201}}").problems,
              HasSubstr("fleet.yaml:1: dds.base_domain: expected at most 200"));
  EXPECT_THAT(loopback_of("{dds: {base_domain: -1}}").problems,
              HasSubstr("dds.base_domain: expected a whole number"));
  EXPECT_THAT(loopback_of("{dds: {qos: nowhere}}").problems,
              HasSubstr("dds.qos: nowhere/onboard.xml: no such file; expected the folder"));
  EXPECT_THAT(loopback_of("{dds: {onboard: {domain: 3}}}").problems, HasSubstr("dds.onboard: unknown key"));
}

}  // namespace
}  // namespace fleetmap::config
