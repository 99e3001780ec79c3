#include "fleetmap/planning/mission/mission_complete.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

TEST(MissionComplete, NeedsAConnectedFleetWithGoodAlignmentsAndTheSameNodes) {
  const AgentId a = testing::name(0), b = testing::name(1), c = testing::name(2);
  const std::vector<AgentId> fleet = {a, b, c};
  using Pairs = std::vector<PairAlignment>;
  EXPECT_TRUE(mapping_complete(fleet, Pairs{{a, b, 0.3}, {c, b, 0.4}}, true).complete);
  const Completeness unshared = mapping_complete(fleet, Pairs{{a, b, 0.3}, {c, b, 0.4}}, false);
  EXPECT_FALSE(unshared.complete);
  EXPECT_NE(unshared.why_not.find("nodes"), std::string::npos);
  const Completeness apart =
      mapping_complete(fleet, Pairs{{a, b, 0.3}, {c, b, 0.41}, {a, c, std::nan("")}}, true);
  EXPECT_FALSE(apart.complete);
  EXPECT_NE(apart.why_not.find("r3"), std::string::npos);
  EXPECT_FALSE(mapping_complete(fleet, Pairs{{a, b, 0.1}, {c, c, 0.1}, {c, *AgentId::parse("x"), 0.1}}, true)
                   .complete);
  EXPECT_TRUE(mapping_complete(std::vector<AgentId>{a}, Pairs{}, true).complete);
  EXPECT_FALSE(mapping_complete({}, Pairs{}, true).complete);
}

}  // namespace
}  // namespace fleetmap::planning
