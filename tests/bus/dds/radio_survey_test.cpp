// The robots heard on a radio and their differences, in the log of the robots and in DdsBus::survey().
#include <gmock/gmock.h>

#include "bus/dds/lone_radio.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

using RadioSurveyTest = LoneRadio;

TEST(Hello, CarriesTheSettings) {
  const auto decoded = decode_hello(encode(some_hello()));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->settings, kSettings);
  EXPECT_EQ(decoded->link, Link::kShortRange);
  EXPECT_EQ(decoded->reads, some_hello().reads);
  Hello without = some_hello();
  without.settings.reset();
  EXPECT_EQ(decode_hello(encode(without))->settings, std::nullopt);
}

TEST(Hello, RobotOfAnotherVersionIsNamedWithItsAddress) {
  Bytes bytes = encode(some_hello());
  EXPECT_FALSE(decode_other_hello(bytes));
  for (const std::uint8_t version : std::initializer_list<std::uint8_t>{2, 3, 5, 200}) {
    bytes[4] = version;
    EXPECT_FALSE(decode_hello(bytes));
    const auto other = decode_other_hello(bytes);
    ASSERT_TRUE(other);
    EXPECT_EQ(other->version, version);
    EXPECT_EQ(other->sender, name("r2"));
    EXPECT_EQ(other->address, some_hello().address);
    EXPECT_EQ(other->port, 7660);
  }
  for (std::size_t size = 0; size < 32; ++size)
    EXPECT_FALSE(decode_other_hello({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}));
}

TEST(FleetSettings, EachDifferenceIsASentence) {
  EXPECT_THAT(differences("r2", kSettings, kSettings), IsEmpty());
  const FleetSettings other{
      .wire_schema = 4, .fleet = 1, .submap_voxel = 2000, .map_voxel = 125, .placement = 8};
  EXPECT_THAT(differences("r2", other, kSettings),
              ElementsAre(HasSubstr("r2 sends messages of version 4, ours are 3"),
                          HasSubstr("r2's fleet list is another"),
                          HasSubstr("r2's submaps have voxels of 0.20 m, ours 0.10 m"),
                          HasSubstr("r2's map has voxels of 0.0125 m, ours 0.10 m"),
                          HasSubstr("r2 places nodes by other settings")));
}

TEST_F(RadioSurveyTest, RobotsThatAgreeAreHeardAndNothingElseIsSaid) {
  const DdsBus& first = start(robot("r1"));
  const DdsBus& second = start(robot("r2"));
  ASSERT_TRUE(run_until([&] { return heard(first) == 1 && heard(second) == 1; }));
  const RadioSurvey survey = first.survey(Link::kLongRange);
  EXPECT_EQ(survey.problem, "");
  EXPECT_EQ(survey.robots[0].agent, name("r2"));
  EXPECT_EQ(survey.robots[0].settings, kSettings);
  EXPECT_EQ(survey.robots[0].domain, first_test_domain());
  EXPECT_TRUE(survey.robots[0].here);
  EXPECT_THAT(log_.text(), AllOf(HasSubstr("long_range: heard r2 at 127.0.0.1:"), Not(HasSubstr("warning"))));
}

TEST_F(RadioSurveyTest, DifferentSettingsAreReportedOnceByBoth) {
  FleetSettings other = kSettings;
  other.submap_voxel = 2000;
  other.fleet = 1;
  const DdsBus& first = start(robot("r1"));
  start(robot("r2", other));
  ASSERT_TRUE(run_until([&] { return log_.count("fleet list is another") == 2; })) << log_.text();
  EXPECT_EQ(log_.count("long_range: r2's submaps have voxels of 0.20 m, ours 0.10 m"), 1);
  EXPECT_EQ(log_.count("long_range: r1's submaps have voxels of 0.10 m, ours 0.20 m"), 1);
  // Started anew it says Hello anew, but there is nothing new to say.
  buses_.pop_back();
  start(robot("r2", other));
  ASSERT_TRUE(run_until([&] { return log_.count("heard r2") == 2 && heard(*buses_.back()) == 1; }));
  EXPECT_EQ(log_.count("r2's submaps have voxels"), 1);
  EXPECT_EQ(first.survey(Link::kLongRange).robots.back().settings, other);
}

TEST_F(RadioSurveyTest, AnObserverLeavesTheFirstPortToTheRobotAndIsNotTakenForOne) {
  DdsBusConfig observer = robot("r1", std::nullopt);  // even under the robot's name
  observer.observes = true;
  const DdsBus& check = start(observer);
  const DdsBus& first = start(robot("r1"));
  ASSERT_TRUE(run_until([&] { return heard(check) == 1 && heard(first) == 1; }));
  const int port = 7410 + 250 * static_cast<int>(first_test_domain());
  EXPECT_EQ(check.survey(Link::kLongRange).robots[0].place, "127.0.0.1:" + std::to_string(port));
  EXPECT_EQ(first.survey(Link::kLongRange).robots[0].place, "127.0.0.1:" + std::to_string(port + 2));
  EXPECT_EQ(first.survey(Link::kLongRange).robots[0].settings, std::nullopt);
  EXPECT_THAT(log_.text(), AllOf(HasSubstr("(an operator's program)"), Not(HasSubstr("is named r1, too"))));
  std::swap(buses_.front(), buses_.back());
  buses_.pop_back();
  EXPECT_TRUE(run_until([&] { return log_.count("r1 leaves") == 1; }));
}

TEST_F(RadioSurveyTest, ARobotInAnotherDomainIsFoundByWhoLooksThere) {
  DdsBusConfig elsewhere = robot("r2");
  elsewhere.long_range.domain += 5;
  DdsBusConfig observer = robot("check", std::nullopt);
  observer.observes = true;
  observer.long_range.other_domains = {elsewhere.long_range.domain};
  start(elsewhere);
  const DdsBus& check = start(observer);
  ASSERT_TRUE(run_until([&] { return heard(check) == 1; }));
  EXPECT_EQ(check.survey(Link::kLongRange).robots[0].agent, name("r2"));
  EXPECT_EQ(check.survey(Link::kLongRange).robots[0].domain, elsewhere.long_range.domain);
}

TEST_F(RadioSurveyTest, RadiosThatAreMixedUpAreNamed) {
  DdsBusConfig mixed = robot("r2");
  mixed.short_range = mixed.long_range;
  mixed.long_range.enabled = false;
  mixed.short_range.enabled = true;
  const DdsBus& first = start(robot("r1"));
  start(mixed);
  ASSERT_TRUE(run_until([&] { return !first.survey(Link::kLongRange).refused.empty(); }));
  EXPECT_THAT(first.survey(Link::kLongRange).refused, ElementsAre(HasSubstr("r2 has its short_range here")));
  EXPECT_EQ(heard(first), 0u);
  EXPECT_EQ(log_.count("r2 has its short_range here"), 1);
}

TEST_F(RadioSurveyTest, ARobotOfAnotherVersionIsNamedOncePerAddress) {
  const DdsBus& first = start(robot("r1"));
  const auto own = static_cast<std::uint16_t>(7410 + 250 * first_test_domain());
  Hello hello = some_hello();
  hello.address = {127, 0, 0, 1};
  std::uint8_t sent = 0;
  const auto said = [&] { return first.survey(Link::kLongRange).refused.size(); };
  for (std::size_t robots = 1; robots <= 2; ++robots) {
    hello.port = static_cast<std::uint16_t>(own + 2 * robots);
    Bytes old = encode(hello);
    old[4] = 2;
    ASSERT_TRUE(run_until([&] {
      send_to(own, rtps_message(old, ++sent));
      return said() == robots;
    })) << log_.text();
  }
  EXPECT_EQ(log_.count("r2 runs another version of fleetmap (its Hello is of version 2)"), 2);
  EXPECT_EQ(heard(first), 0u);
}

}  // namespace
}  // namespace fleetmap::bus::testing
