#include "agent_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "section_problems.hpp"

namespace fleetmap::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

AgentReading agent_section_of(const std::string& yaml) { return agent_of(yaml, read_agent); }

TEST(AgentSections, ReadsNameFleetFolderAndOrigin) {
  const AgentReading r =
      agent_section_of("id: r2\nfleet: [r1, r2]\ndirectory: out\nsite: {origin: [48.5, 9.25, 430]}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.agent.id.str(), "r2");
  ASSERT_EQ(r.agent.exchange.fleet.size(), 2u);
  EXPECT_EQ(r.agent.exchange.fleet[0].str(), "r1");
  EXPECT_EQ(r.agent.directory.filename(), "out");
  ASSERT_TRUE(r.agent.site_origin);
  EXPECT_DOUBLE_EQ(r.agent.site_origin->latitude, 48.5 * std::numbers::pi / 180.0);
  EXPECT_EQ(r.agent.site_origin->altitude, 430.0);
  ASSERT_TRUE(r.agent.perception.localization.site_origin) << "the EKF works in the same frame";
  EXPECT_EQ(r.agent.perception.localization.site_origin->latitude, r.agent.site_origin->latitude);
}

TEST(AgentSections, NamesThatAreNoneAreProblems) {
  EXPECT_THAT(agent_section_of("id: r 1\nfleet: [r1]\n").problems, HasSubstr("robot.yaml:1: id: "));
  EXPECT_THAT(agent_section_of("id: r1\nfleet: [r1, '']\n").problems, HasSubstr("robot.yaml:2: fleet: "));
}

TEST(AgentSections, AnOriginIsALatitudeALongitudeAndAnAltitude) {
  EXPECT_THAT(agent_section_of("id: r1\nsite: {origin: [95, 9, 0]}\n").problems,
              HasSubstr("robot.yaml:2: site.origin: expected [latitude"));
  for (const char* altitude : {"-501", "9001", "600000"}) {
    EXPECT_THAT(
        agent_section_of("id: r1\nsite: {origin: [39, -3, " + std::string(altitude) + "]}\n").problems,
        AllOf(HasSubstr("robot.yaml:2: site.origin: the altitude is " + std::string(altitude) + " m"),
              HasSubstr("-500 to 9000 m"), HasSubstr("altitude in metres")));
  }
  EXPECT_EQ(agent_section_of("id: r1\nsite: {origin: [31.5, 35.5, -430]}\n").problems, "");
  EXPECT_THAT(agent_section_of("id: r1\nsite: {origin: [48, 9]}\n").problems,
              HasSubstr("robot.yaml:2: site.origin: "));
  EXPECT_THAT(agent_section_of("id: r1\nsite: {orign: [48, 9, 0]}\n").problems,
              HasSubstr("did you mean 'origin'?"));
}

TEST(AgentSections, ModePaperIsThePapersSchemeThroughout) {
  const AgentReading fleet = agent_section_of("id: r1\nmode: fleet\n"), none = agent_section_of("id: r1\n"),
                     paper = agent_section_of("id: r1\nmode: paper\n");
  EXPECT_EQ(fleet.problems + none.problems + paper.problems, "");
  EXPECT_EQ(none.agent.registration.method, registration::Method::correlation);
  EXPECT_EQ(fleet.agent.placement.method, graph::PlacementMethod::graph);
  EXPECT_EQ(paper.agent.registration.method, registration::Method::paper);
  EXPECT_EQ(paper.agent.placement.method, graph::PlacementMethod::paper);
  EXPECT_EQ(paper.agent.spherize.ground_voxel_m, 0.0f) << "the paper keeps no ground";
  EXPECT_EQ(paper.agent.loop_closure.proximity.uncertainty, place::Uncertainty::variance);
  EXPECT_EQ(paper.agent.loop_closure.order, exchange::CloudOrder::kFirstCome);
  EXPECT_EQ(paper.agent.loop_closure.min_information, 0.0);
  EXPECT_THAT(agent_section_of("id: r1\nmode: papr\n").problems,
              HasSubstr("robot.yaml:2: mode: expected 'paper' or 'fleet', found 'papr'"));
}

TEST(AgentSections, TheShareOfTheCpuForLivePlacementsIsBounded) {
  EXPECT_EQ(agent_section_of("id: r1\nplacement: {live_cpu_share: 0.1}\n").agent.live_placement.cpu_share,
            0.1);
  EXPECT_THAT(agent_section_of("id: r1\nplacement: {live_cpu_share: 2}\n").problems,
              HasSubstr("placement.live_cpu_share"));
}

TEST(AgentSections, ASectionSetsEachPartOfThePapersSchemeAlone) {
  const AgentReading r = agent_section_of(
      "id: r1\nmode: paper\nregistration: {method: correlation}\nspherize: {ground_voxel: 1.5}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.agent.registration.method, registration::Method::correlation);
  EXPECT_EQ(r.agent.placement.method, graph::PlacementMethod::paper);
  EXPECT_EQ(r.agent.spherize.ground_voxel_m, 1.5f);
}

}  // namespace
}  // namespace fleetmap::config
