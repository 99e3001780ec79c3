#include "mapping_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "section_problems.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

AgentReading mapping_of(const std::string& yaml) { return agent_of(yaml, read_mapping); }

TEST(MappingSections, ReadsNodesSubmapAndMap) {
  const AgentReading r = mapping_of(
      "nodes: {spacing: 3}\n"
      "submap: {voxel: 0.2, resolution: 0.05, scan_spacing: 0.4, scan_angle_deg: 90, max_bytes: 20000}\n"
      "map: {voxel: 0.3, centroids: true}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.agent.nodes.spacing, 3.0);
  EXPECT_EQ(r.agent.submap.voxel, 0.2);
  EXPECT_EQ(r.agent.submap.resolution, 0.05);
  EXPECT_EQ(r.agent.submap.scan_spacing, 0.4);
  EXPECT_DOUBLE_EQ(r.agent.submap.scan_angle, std::numbers::pi / 2.0);
  EXPECT_EQ(r.agent.submap.max_bytes, 20'000u);
  EXPECT_EQ(r.agent.map.voxel_m, 0.3);
  EXPECT_TRUE(r.agent.map.centroids);
}

TEST(MappingSections, ProblemsNameTheKeyOrTheSection) {
  EXPECT_THAT(mapping_of("nodes:\n  spacing: 0\n").problems, HasSubstr("robot.yaml:2: nodes.spacing: "));
  EXPECT_THAT(mapping_of("submap:\n  voxel: 9\n").problems,
              HasSubstr("submap voxel must lie in [0.01, 5] m"));
  EXPECT_THAT(mapping_of("map:\n  voxel: 0\n").problems, HasSubstr("robot.yaml:2: map.voxel: "));
  EXPECT_THAT(mapping_of("map: {centroid: true}\n").problems, HasSubstr("did you mean 'centroids'?"));
}

}  // namespace
}  // namespace fleetmap::config
