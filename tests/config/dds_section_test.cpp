#include "dds_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "section_problems.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct DdsReading {
  bus::DdsBusConfig dds;
  std::string problems;
};

DdsReading dds_of(const std::string& yaml) {
  DdsReading result;
  result.dds.agent = AgentId::parse("r1").value();
  result.problems = problems_of(yaml, [&](Section& top) { read_dds(top, result.dds); });
  return result;
}

TEST(DdsSection, ReadsEachLink) {
  const DdsReading r = dds_of(
      "dds:\n"
      "  qos: profiles\n"
      "  onboard: {domain: 10, shared_memory: false}\n"
      "  long_range: {domain: 11, address: 127.0.0.2, peers: ['127.0.0.3', '127.0.0.4:7500'],\n"
      "    participants_per_peer: 4, multicast: true}\n"
      "  short_range: {domain: 12, enabled: false}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.dds.qos_directory.filename(), "profiles");
  EXPECT_EQ(r.dds.onboard.domain, 10u);
  EXPECT_FALSE(r.dds.onboard.shared_memory);
  EXPECT_EQ(r.dds.long_range.domain, 11u);
  EXPECT_EQ(r.dds.long_range.address, "127.0.0.2");
  EXPECT_EQ(r.dds.long_range.peers, (std::vector<std::string>{"127.0.0.3", "127.0.0.4:7500"}));
  EXPECT_EQ(r.dds.long_range.participants_per_peer, 4u);
  EXPECT_TRUE(r.dds.long_range.multicast);
  EXPECT_EQ(r.dds.short_range.domain, 12u);
  EXPECT_FALSE(r.dds.short_range.enabled);
  EXPECT_TRUE(r.dds.onboard.enabled);
}

TEST(DdsSection, ProblemsNameTheLinkAndTheKey) {
  EXPECT_THAT(dds_of("dds:\n  long_range: {domain: 0}\n").problems,
              HasSubstr("long_range.domain must differ"));
  EXPECT_THAT(dds_of("dds:\n  long_range: {adress: 127.0.0.1}\n").problems,
              HasSubstr("robot.yaml:2: dds.long_range.adress: unknown key; did you mean 'address'?"));
  EXPECT_THAT(dds_of("dds:\n  onboard: {domain: 300}\n").problems,
              HasSubstr("robot.yaml:2: dds.onboard.domain: onboard.domain is 300"));
}

TEST(DdsSection, TheFolderOfProfilesHoldsThoseOfAllLinks) {
  const testing::TemporaryFolder folder;
  const auto problems = [&] {
    return problems_of("qos: q\n", [&](Section& top) { check_profiles(top, folder.path()); });
  };
  for (const char* file : {"onboard.xml", "long_range.xml"}) {
    EXPECT_THAT(problems(), HasSubstr(std::string("robot.yaml:1: qos: ") + (folder.path() / file).string()));
    folder.write(file, "<dds/>");
  }
  EXPECT_THAT(problems(), HasSubstr("short_range.xml"));
  folder.write("short_range.xml", "<dds/>");
  EXPECT_EQ(problems(), "");
}

}  // namespace
}  // namespace fleetmap::config
