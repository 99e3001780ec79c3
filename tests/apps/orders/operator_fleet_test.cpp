#include "orders/operator_fleet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "store/items.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class OperatorFleetTest : public ::testing::Test {
 protected:
  std::string robot_file(const std::string& keys = "") const {
    return folder_.write("r1.yaml", "id: r1\nfleet: [r1, r2]\ndirectory: out\n" + keys).string();
  }
  testing::TemporaryFolder folder_;
};

TEST_F(OperatorFleetTest, RobotFileAddressesTheRobotItselfToo) {
  const std::string file = robot_file(
      "dds:\n  long_range: {peers: [10.0.0.2], address: 10.0.0.1}\n  short_range: {enabled: false}\n");
  const auto fleet = operator_fleet(file, {});
  ASSERT_TRUE(fleet) << fleet.error().message;
  EXPECT_THAT(fleet->robots, ElementsAre(testing::agent("r1"), testing::agent("r2")));
  EXPECT_EQ(fleet->dds.agent, testing::agent("operator"));
  EXPECT_THAT(fleet->dds.long_range.peers, ElementsAre("10.0.0.2", "10.0.0.1"));
  EXPECT_TRUE(fleet->dds.long_range.enabled);
  EXPECT_FALSE(fleet->dds.short_range.enabled || fleet->dds.onboard.enabled) << "orders go over one radio";
  EXPECT_FALSE(fleet->dds.settings) << "an operator has no settings to compare";
}

TEST_F(OperatorFleetTest, FleetFileAddressesAllMembers) {
  const auto fleet = operator_fleet(FLEETMAP_SOURCE_DIR "/config/fleets/farm_small.yaml", {});
  ASSERT_TRUE(fleet) << fleet.error().message;
  EXPECT_THAT(fleet->robots, ElementsAre(testing::agent("r1"), testing::agent("r2"), testing::agent("r3"),
                                         testing::agent("r4"), testing::agent("r5")));
}

TEST_F(OperatorFleetTest, AnotherFileIsRefused) {
  const auto fleet = operator_fleet(FLEETMAP_SOURCE_DIR "/config/sensors/vlp16.yaml", {});
  ASSERT_FALSE(fleet);
  EXPECT_THAT(fleet.error().message, HasSubstr("vlp16.yaml: is no robot's and no fleet's configuration"));
}

TEST_F(OperatorFleetTest, ARobotIsFoundByItsName) {
  const OperatorFleet fleet{{testing::agent("r1"), testing::agent("r2")}, {}};
  EXPECT_EQ(robot_named(fleet, "r2", "f.yaml"), testing::agent("r2"));
  const auto none = robot_named(fleet, "r9", "f.yaml");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "f.yaml: has no robot 'r9'");
}

}  // namespace
}  // namespace fleetmap::apps
