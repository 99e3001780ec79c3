// The robots heard on a radio and their differences, in the log of the robots and in DdsBus::survey().
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/captured_log.hpp"
#include "bus/dds/hello.hpp"
#include "bus/dds_domains.hpp"
#include "fleetmap/bus/dds_bus.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr auto kPatience = std::chrono::seconds(60);
constexpr FleetSettings kSettings{
    .wire_schema = 3, .fleet = 0x12345678, .submap_voxel = 1000, .map_voxel = 1000, .placement = 7};

AgentId name(const char* text) { return AgentId::parse(text).value(); }

class RadioSurveyTest : public ::testing::Test {
 protected:
  /// On the long range of this machine alone.
  static DdsBusConfig robot(const char* id, const std::optional<FleetSettings>& settings = kSettings) {
    DdsBusConfig config;
    config.agent = name(id);
    config.qos_directory = FLEETMAP_SOURCE_DIR "/qos";
    config.onboard.enabled = false;
    config.short_range.enabled = false;
    config.long_range.domain = first_test_domain();
    config.long_range.address = "127.0.0.1";
    config.settings = settings;
    return config;
  }
  DdsBus& start(const DdsBusConfig& config) {
    auto bus = DdsBus::create(config);
    if (!bus) throw std::runtime_error(bus.error().message);
    buses_.push_back(*std::move(bus));
    return *buses_.back();
  }
  bool run_until(const std::function<bool()>& done) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < deadline) {
      for (const auto& bus : buses_) {
        if (bus->run_until(done, std::chrono::milliseconds(5))) return true;
      }
    }
    return done();
  }
  static std::size_t heard(const DdsBus& bus) { return bus.survey(Link::kLongRange).robots.size(); }

  CapturedLog log_;
  std::vector<std::unique_ptr<DdsBus>> buses_;
};

Hello some_hello() {
  Hello hello;
  hello.knows.fill(9);
  hello.sender = name("r2");
  hello.address = {10, 0, 0, 2};
  hello.port = 7660;
  hello.settings = kSettings;
  hello.link = Link::kShortRange;
  hello.reads = {1, 2, 3};
  return hello;
}

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

TEST(Hello, OfAnotherVersionSaysWhoAndWhere) {
  Bytes bytes = encode(some_hello());
  EXPECT_FALSE(decode_other_hello(bytes));
  for (const std::uint8_t version : std::initializer_list<std::uint8_t>{2, 4, 200}) {
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

TEST_F(RadioSurveyTest, WhatDiffersIsSaidOnceByBoth) {
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
  ASSERT_TRUE(run_until([&] { return !first.survey(Link::kLongRange).notices.empty(); }));
  EXPECT_THAT(first.survey(Link::kLongRange).notices, ElementsAre(HasSubstr("r2 has its short_range here")));
  EXPECT_EQ(heard(first), 0u);
  EXPECT_EQ(log_.count("r2 has its short_range here"), 1);
}

/// `payload` as one DATA submessage of RTPS 2.2 from the participant with prefix {participant, 2, 3, ...,
/// 12}.
Bytes rtps_message(const Bytes& payload, std::uint8_t number, std::uint8_t participant = 1) {
  Bytes bytes{'R', 'T', 'P', 'S', 2, 2, 1, 15, participant, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const auto length = static_cast<std::uint16_t>(20 + payload.size());
  bytes.insert(bytes.end(),
               {0x15, 0x05, static_cast<std::uint8_t>(length), static_cast<std::uint8_t>(length >> 8)});
  bytes.insert(bytes.end(), {0, 0, 16, 0});       // offset of what follows the sequence number
  bytes.insert(bytes.end(), {0, 0, 0, 0});        // to any reader
  bytes.insert(bytes.end(), {0xff, 0, 1, 0x03});  // of this writer
  bytes.insert(bytes.end(), {0, 0, 0, 0, number, 0, 0, 0});
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

void send_to(std::uint16_t port, const Bytes& bytes) {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  sendto(fd, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  close(fd);
}

TEST_F(RadioSurveyTest, ARobotOfAnotherVersionIsNamedOncePerAddress) {
  const DdsBus& first = start(robot("r1"));
  const auto own = static_cast<std::uint16_t>(7410 + 250 * first_test_domain());
  Hello hello = some_hello();
  hello.address = {127, 0, 0, 1};
  std::uint8_t sent = 0;
  const auto said = [&] { return first.survey(Link::kLongRange).notices.size(); };
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

/// r1 has heard r2, whose messages the test sends, and then one Hello of another participant at r2's place.
class RadioClaim : public RadioSurveyTest {
 protected:
  void SetUp() override {
    start(robot("r1"));
    hello_.link = Link::kLongRange;
    hello_.address = {127, 0, 0, 1};
    hello_.port = static_cast<std::uint16_t>(own_ + 2);
    ASSERT_TRUE(run_until([&] {
      send_hello_of_r2();
      return log_.count("heard r2") == 1;
    })) << log_.text();
    send_to(own_, rtps_message(encode(hello_), 1, /*participant=*/2));
  }
  void send_hello_of_r2() { send_to(own_, rtps_message(encode(hello_), ++sent_, /*participant=*/1)); }

  const std::uint16_t own_ = static_cast<std::uint16_t>(7410 + 250 * first_test_domain());
  Hello hello_ = some_hello();
  std::uint8_t sent_ = 0;
};

/// Killed and started again: one Hello of the new start is enough although the one before was just heard.
TEST_F(RadioClaim, ARobotThatStartsAnewAtOnceIsKnownByItsFirstHello) {
  EXPECT_TRUE(run_until([&] { return log_.count("heard r2") == 2; })) << log_.text();
}

/// Somebody may only say to be at a robot's place: who goes on speaking stays known.
TEST_F(RadioClaim, ARobotThatGoesOnSpeakingIsNotReplaced) {
  // A third robot is heard well after the claim could have been taken: time enough went by.
  Hello third = hello_;
  third.sender = name("r3");
  third.port = static_cast<std::uint16_t>(own_ + 4);
  const auto begun = std::chrono::steady_clock::now();
  auto next = begun;
  ASSERT_TRUE(run_until([&] {
    const auto now = std::chrono::steady_clock::now();
    if (now < next) return false;
    next = now + std::chrono::milliseconds(100);
    send_hello_of_r2();
    if (now - begun > std::chrono::seconds(3))
      send_to(own_, rtps_message(encode(third), ++sent_, /*participant=*/3));
    return log_.count("heard r3") == 1;
  })) << log_.text();
  EXPECT_EQ(log_.count("heard r2"), 1);
}

}  // namespace
}  // namespace fleetmap::bus::testing
