#include "bus/dds/radio_notices.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::bus {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

RadioSurvey::Robot robot_at(const std::string& name, const std::string& place) {
  RadioSurvey::Robot robot;
  robot.agent = AgentId::parse(name).value();
  robot.place = place;
  return robot;
}

TEST(RadioNotices, ARobotIsListedOnceForEachAddressAndUpdated) {
  RadioNotices notices(Link::kLongRange, false, FleetSettings{});
  notices.note(robot_at("r1", "10.0.0.1:7660"));
  notices.note(robot_at("r1", "10.0.0.2:7660"));
  RadioSurvey::Robot again = robot_at("r1", "10.0.0.1:7660");
  again.multicast = true;
  again.settings = FleetSettings{};
  notices.note(again);
  ASSERT_EQ(notices.robots().size(), 2u);
  EXPECT_TRUE(notices.robots()[0].multicast);
  EXPECT_TRUE(notices.robots()[0].settings.has_value());
  EXPECT_FALSE(notices.robots()[1].multicast);
}

TEST(RadioNotices, TheListsAreBounded) {
  RadioNotices notices(Link::kLongRange, false, std::nullopt);
  for (int k = 0; k < 1000; ++k) {
    notices.note(robot_at("r1", std::to_string(k)));
    notices.refuse(std::to_string(k), "another version");
  }
  EXPECT_EQ(notices.robots().size(), 256u);
  EXPECT_EQ(notices.refusals().size(), 128u);
}

TEST(RadioNotices, ARefusalIsReportedOnce) {
  RadioNotices notices(Link::kLongRange, false, std::nullopt);
  notices.refuse("10.0.0.1:7660", "another version");
  notices.refuse("10.0.0.1:7660", "another version");
  notices.refuse("10.0.0.1:7660", "revoked");
  EXPECT_THAT(notices.refusals(), ElementsAre("10.0.0.1:7660: another version", "10.0.0.1:7660: revoked"));
}

TEST(RadioNotices, RobotOfTheSameNameIsKept) {
  RadioNotices notices(Link::kLongRange, false, FleetSettings{});
  notices.add_namesake("10.0.0.1:7660", AgentId::parse("r1").value());
  EXPECT_THAT(notices.refusals(), ElementsAre(HasSubstr("another robot at 10.0.0.1:7660 is named r1, too")));
}

TEST(RadioNotices, OtherSettingsOfARobotAreKeptOnce) {
  RadioNotices notices(Link::kLongRange, false, FleetSettings{});
  Hello hello;
  hello.sender = AgentId::parse("r2").value();
  hello.settings = FleetSettings{};
  hello.settings->fleet = 7;
  hello.multicast = true;
  for (int k = 0; k < 2; ++k) notices.compare(hello);
  EXPECT_THAT(notices.refusals(), IsEmpty());
  EXPECT_THAT(notices.differences(), ElementsAre(HasSubstr("r2 has dds.long_range.multicast"),
                                                 HasSubstr("r2's fleet list is another")));
}

}  // namespace
}  // namespace fleetmap::bus
