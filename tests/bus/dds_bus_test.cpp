// The parts that only the Fast DDS bus has: its profile files and its configuration.

#include "fleetmap/bus/dds_bus.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "bus/dds_domains.hpp"
#include "fleetmap/bus/wire_overhead.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A copy of the shipped profiles that a test may spoil.
class QosDirectory : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ = fs::path(::testing::TempDir()) / ("fleetmap-qos-" + std::to_string(getpid()));
    fs::remove_all(directory_);
    fs::copy(FLEETMAP_SOURCE_DIR "/qos", directory_);
    config_.agent = AgentId::parse("r1").value();
    config_.qos_directory = directory_;
    config_.onboard.domain = first_test_domain();
    config_.long_range.domain = first_test_domain() + 1;
    config_.short_range.domain = first_test_domain() + 2;
    config_.long_range.address = config_.short_range.address = "127.0.0.1";
  }
  void TearDown() override { fs::remove_all(directory_); }

  void replace(const std::string& file, const std::string& from, const std::string& to) {
    std::ifstream in(directory_ / file);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    std::ofstream(directory_ / file) << text;
  }
  std::string error() const {
    const auto bus = DdsBus::create(config_);
    return bus ? "none" : bus.error().message;
  }

  /// False after a minute without `done()`.
  static bool run_both(DdsBus& first, DdsBus& second, const std::function<bool()>& done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      for (DdsBus* bus : {&first, &second}) {
        if (bus->run_until(done, std::chrono::milliseconds(5))) return true;
      }
    }
    return false;
  }

  fs::path directory_;
  DdsBusConfig config_;
};

TEST_F(QosDirectory, TheShippedProfilesAreAccepted) { EXPECT_EQ(error(), "none"); }

TEST_F(QosDirectory, AMissingFileIsNamed) {
  fs::remove(directory_ / "long_range.xml");
  EXPECT_THAT(error(), HasSubstr((directory_ / "long_range.xml").string() + ": cannot be read"));
}

TEST_F(QosDirectory, AMissingDirectoryIsNamed) {
  config_.qos_directory = directory_ / "nowhere";
  EXPECT_THAT(error(), HasSubstr("nowhere/onboard.xml: cannot be read"));
}

TEST_F(QosDirectory, MalformedXmlIsNamedWithItsLine) {
  replace("onboard.xml", "</transport_descriptors>", "</transport_descriptor>");
  EXPECT_THAT(error(), ::testing::ContainsRegex("onboard\\.xml:[0-9]+: is not well-formed XML"));
}

TEST_F(QosDirectory, AnEmptyFileIsNotWellFormed) {
  std::ofstream(directory_ / "onboard.xml") << "";
  EXPECT_THAT(error(), HasSubstr("is not well-formed XML"));
}

TEST_F(QosDirectory, AnotherRootElementIsRefused) {
  std::ofstream(directory_ / "short_range.xml") << "<?xml version=\"1.0\"?>\n<qos/>\n";
  EXPECT_THAT(error(),
              HasSubstr("short_range.xml:2: the root element is <qos>; expected <dds> or <profiles>"));
}

TEST_F(QosDirectory, AnUnknownElementIsNamedWithItsLineAndWhatMayStandThere) {
  replace("long_range.xml", "<depth>32</depth>", "<deepth>32</deepth>");
  EXPECT_THAT(error(),
              ::testing::ContainsRegex("long_range\\.xml:[0-9]+: unknown element <deepth> in <historyQos>; "
                                       "expected one of <kind>, <depth>"));
}

TEST_F(QosDirectory, AValueOfTheWrongKindIsNamed) {
  replace("onboard.xml", "<depth>5</depth>", "<depth>five</depth>");
  EXPECT_THAT(error(), HasSubstr("<depth> is \"five\"; expected a whole number >= 0"));
}

TEST_F(QosDirectory, AnUnknownWordIsNamed) {
  replace("short_range.xml", "<kind>BEST_EFFORT</kind>", "<kind>BEST_EFORT</kind>");
  EXPECT_THAT(error(), HasSubstr("<kind> is \"BEST_EFORT\"; expected one of BEST_EFFORT|RELIABLE"));
}

TEST_F(QosDirectory, AReliableRadioIsRefusedSinceItsRepairsHaveNoEnd) {
  replace("short_range.xml", "<kind>BEST_EFFORT</kind>", "<kind>RELIABLE</kind>");
  EXPECT_THAT(error(), HasSubstr("<data_writer> \"control\" is reliable; short_range is best effort"));
}

TEST_F(QosDirectory, ADefaultProfileIsRefusedSinceItWouldChangeTheWholeProcess) {
  replace("onboard.xml", "<participant profile_name",
          "<participant is_default_profile=\"true\" profile_name");
  EXPECT_THAT(error(), HasSubstr("attribute is_default_profile of <participant> is not allowed here"));
}

TEST_F(QosDirectory, AProfileDefinedTwiceIsNamedWithBothLines) {
  replace("onboard.xml", "<data_writer profile_name=\"state\">", "<data_writer profile_name=\"sensor\">");
  EXPECT_THAT(error(), HasSubstr("<data_writer> \"sensor\" is already defined at line"));
}

TEST_F(QosDirectory, ATransportThatIsNotDefinedIsNamed) {
  replace("short_range.xml", "<transport_id>wifi</transport_id>", "<transport_id>lan</transport_id>");
  EXPECT_THAT(error(), HasSubstr("no <transport_descriptor> has the id \"wifi\""));
}

class MissingProfile : public QosDirectory,
                       public ::testing::WithParamInterface<std::pair<Link, std::string>> {};

TEST_P(MissingProfile, IsNamed) {
  const auto& [link, profile] = GetParam();
  const std::string file = std::string(to_string(link)) + ".xml";
  for (const char* kind : {"participant", "data_writer", "data_reader"}) {
    const bool participant = kind == std::string("participant");
    const std::string name = participant ? to_string(link) : profile;
    SetUp();
    replace(file, std::string("<") + kind + " profile_name=\"" + name + "\"",
            std::string("<") + kind + " profile_name=\"another\"");
    std::ostringstream missing;
    missing << file << ": no <" << kind << " profile_name=\"" << name << "\">; add that profile";
    EXPECT_THAT(error(), HasSubstr(missing.str()));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Profiles, MissingProfile,
    ::testing::Values(std::pair{Link::kOnboard, "sensor"}, std::pair{Link::kOnboard, "state"},
                      std::pair{Link::kLongRange, "small"}, std::pair{Link::kLongRange, "cloud"},
                      std::pair{Link::kShortRange, "control"}, std::pair{Link::kShortRange, "bulk"}),
    [](const auto& info) { return info.param.second; });

TEST_F(QosDirectory, WritersAndReadersOfEveryProfileMatch) {
  auto first = DdsBus::create(config_).value();
  config_.agent = AgentId::parse("r2").value();
  auto second = DdsBus::create(config_).value();
  for (const Link link : {Link::kOnboard, Link::kLongRange, Link::kShortRange}) {
    for (const std::string& profile : profiles_of(link)) {
      const Topic topic{link, "match/" + profile, "fleetmap::Match", profile};
      first->advertise(topic);
      const Handle handle = second->subscribe(topic, [](const Bytes&) {});
      EXPECT_TRUE(run_both(*first, *second, [&] {
        return first->matches(topic).readers == 1 && second->matches(topic).writers == 1;
      }));
    }
  }
}

TEST_F(QosDirectory, ATopicWithAProfileThatTheFileLacksIsABug) {
  const auto bus = DdsBus::create(config_).value();
  EXPECT_THROW(bus->advertise({Link::kOnboard, "t", "T", "bulk"}), std::logic_error);
}

TEST_F(QosDirectory, ADisabledLinkNeedsNoFileAndCountsWhatItDrops) {
  fs::remove(directory_ / "short_range.xml");
  config_.short_range.enabled = false;
  const auto bus = DdsBus::create(config_).value();
  bus->publish({Link::kShortRange, "t", "T", "bulk"}, Bytes(10));
  ASSERT_EQ(bus->stats().size(), 1u);
  EXPECT_EQ(bus->stats()[0].dropped_messages, 1u);
}

TEST_F(QosDirectory, ARadioWhoseAddressIsNotThereKeepsNobodyFromMapping) {
  config_.long_range.address = "192.0.2.77";
  const auto bus = DdsBus::create(config_);
  ASSERT_TRUE(bus) << bus.error().message;
  EXPECT_THAT((*bus)->warnings(),
              ElementsAre(HasSubstr("no interface of this machine has 192.0.2.77 (it has lo "
                                    "127.0.0.1")));
  const Topic topic{Link::kLongRange, "t", "T", "small"};
  const Handle heard = (*bus)->subscribe(topic, [](const Bytes&) {});
  (*bus)->publish(topic, Bytes(10));
  EXPECT_EQ((*bus)->matches(topic).readers, 0u);
}

TEST_F(QosDirectory, AWrongConfigurationIsNamed) {
  const DdsBusConfig good = config_;
  config_.long_range.address.clear();
  config_.long_range.peers = {"127.0.0.1", "192.0.2.78"};
  EXPECT_THAT(error(),
              HasSubstr("long_range.address is not set, but 192.0.2.78 is another machine: give this "
                        "robot's own address on that radio; this machine has lo 127.0.0.1"));
  config_ = good;
  config_.long_range.address = "radio0";
  EXPECT_THAT(error(), HasSubstr("long_range.address is \"radio0\"; must be an IPv4 address"));
  config_ = good;
  config_.short_range.peers = {"10.0.0.2:0"};
  EXPECT_THAT(error(), HasSubstr("short_range.peers has \"10.0.0.2:0\""));
  config_ = good;
  config_.short_range.domain = config_.onboard.domain;
  EXPECT_THAT(error(), HasSubstr("short_range.domain must differ from onboard's"));
  config_ = good;
  config_.onboard.domain = 231;
  EXPECT_THAT(error(), HasSubstr("onboard.domain is 231; must be in [0, 230]"));
}

TEST_F(QosDirectory, OnboardThereIsNoMulticastOfOurs) {
  config_.onboard.multicast = true;
  EXPECT_THAT(error(), HasSubstr("onboard.multicast is for radios"));
}

TEST_F(QosDirectory, StopsAndRunsPostedCallbacks) {
  const auto bus = DdsBus::create(config_).value();
  std::vector<int> order;
  bus->post([&] { order.push_back(1); });
  bus->post([&] {
    order.push_back(2);
    bus->stop();
  });
  bus->run();
  EXPECT_THAT(order, ::testing::ElementsAre(1, 2));
  const std::atomic<bool> stop = true;
  bus->run_until(stop);
}

TEST_F(QosDirectory, APeerThatVanishesDoesNotHoldUpAWriter) {
  const Topic topic{Link::kShortRange, "chunk", "Chunk", "bulk"};
  const auto sender = DdsBus::create(config_).value();
  sender->advertise(topic);
  config_.agent = AgentId::parse("r2").value();
  for (int i = 0; i < 5; ++i) {
    auto receiver = DdsBus::create(config_).value();
    const Handle handle = receiver->subscribe(topic, [](const Bytes&) {});
    ASSERT_TRUE(run_both(*sender, *receiver, [&] { return sender->matches(topic).readers == 1; }));
    for (int n = 0; n < 300; ++n) sender->publish(topic, Bytes(8192));
    receiver.reset();  // in the middle of the burst
    EXPECT_TRUE(
        sender->run_until([&] { return sender->matches(topic).readers == 0; }, std::chrono::seconds(60)));
  }
}

TEST_F(QosDirectory, WhatCameFromEachRobotIsCountedOnce) {
  const Topic topic{Link::kLongRange, "node", "Node", "small"};
  const auto sender = DdsBus::create(config_).value();
  sender->advertise(topic);
  config_.agent = AgentId::parse("r2").value();
  const auto receiver = DdsBus::create(config_).value();
  int came = 0;
  const Handle handle = receiver->subscribe(topic, [&](const Bytes&) { ++came; });
  ASSERT_TRUE(run_both(*sender, *receiver, [&] { return sender->matches(topic).readers == 1; }));
  for (int n = 0; n < 10; ++n) sender->publish(topic, Bytes(200));
  ASSERT_TRUE(run_both(*sender, *receiver,
                       [&] { return came == 10 && receiver->survey(Link::kShortRange).robots.size() == 1; }));
  std::vector<HeardTraffic> heard = receiver->take_heard_traffic();
  ASSERT_EQ(heard.size(), 2u) << "on the short range it has said Hello";
  EXPECT_EQ(heard[1].link, Link::kShortRange);
  EXPECT_EQ(heard[1].messages, 0u);
  EXPECT_GT(heard[1].hellos, 0u);
  EXPECT_EQ(heard[0].link, Link::kLongRange);
  EXPECT_EQ(heard[0].from.str(), "r1");
  EXPECT_EQ(heard[0].messages, 10u);
  EXPECT_EQ(heard[0].bytes, 10 * wire_bytes(200));
  EXPECT_EQ(heard[0].lost, 0u);
  EXPECT_GT(heard[0].delay, Duration::zero());
  EXPECT_LT(heard[0].delay, std::chrono::seconds(10));
  for (const HeardTraffic& again : receiver->take_heard_traffic())
    EXPECT_EQ(again.messages, 0u) << "since the last call nothing came";
  // At least a Hello of 232 bytes to each other; what was published is not among it.
  const std::uint64_t hellos = sender->discovery_bytes(Link::kLongRange);
  EXPECT_GE(hellos, 232u);
  EXPECT_LT(hellos, 20 * 300u);
  EXPECT_EQ(sender->discovery_bytes(Link::kOnboard), 0u);
}

/// How many datagrams arrive at a multicast group on the loopback.
class GroupListener {
 public:
  GroupListener(const char* group, std::uint16_t port)
      : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    const int yes = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr.s_addr = inet_addr(group);
    const ip_mreq membership{{inet_addr(group)}, {inet_addr("127.0.0.1")}};
    good_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof(place)) == 0 &&
            ::setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0;
  }
  ~GroupListener() { ::close(socket_); }
  GroupListener(const GroupListener&) = delete;
  GroupListener& operator=(const GroupListener&) = delete;
  bool good() const { return good_; }
  /// Since the last call.
  int count() const {
    std::array<char, 4096> datagram{};
    int datagrams = 0;
    while (::recv(socket_, datagram.data(), datagram.size(), 0) >= 0) ++datagrams;
    return datagrams;
  }

 private:
  int socket_;
  bool good_ = false;
};

/// r1 tells r2 and r3 twenty times; returns how many datagrams went to the group.
class Multicast : public QosDirectory {
 protected:
  int tell_two(bool multicast, bool third_has_it) {
    config_.long_range.multicast = multicast;
    const Topic topic{Link::kLongRange, "node", "Node", "small"};
    const auto sender = DdsBus::create(config_).value();
    sender->advertise(topic);
    config_.agent = AgentId::parse("r2").value();
    const auto second = DdsBus::create(config_).value();
    config_.agent = AgentId::parse("r3").value();
    config_.long_range.multicast = third_has_it;
    const auto third = DdsBus::create(config_).value();
    int at_second = 0, at_third = 0;
    const Handle first_handle = second->subscribe(topic, [&](const Bytes&) { ++at_second; });
    const Handle second_handle = third->subscribe(topic, [&](const Bytes&) { ++at_third; });
    const auto run_all = [&](const std::function<bool()>& done) {
      return run_both(*second, *third, [&] {
        sender->run_until([] { return false; }, std::chrono::milliseconds(1));
        return done();
      });
    };
    EXPECT_TRUE(run_all([&] { return sender->matches(topic).readers == 2; }));
    // RTPS's multicast port for data: base 7400, 250 a domain, offset 1.
    const GroupListener group("239.255.0.1",
                              static_cast<std::uint16_t>(7401 + 250 * config_.long_range.domain));
    EXPECT_TRUE(group.good());
    for (int n = 0; n < 20; ++n) sender->publish(topic, Bytes(200));
    EXPECT_TRUE(run_all([&] { return at_second >= 20 && at_third >= 20; }));
    // Duplicates would arrive before this message.
    sender->publish(topic, Bytes(200));
    EXPECT_TRUE(run_all([&] { return at_second >= 21 && at_third >= 21; }));
    EXPECT_EQ(at_second, 21);
    EXPECT_EQ(at_third, 21);
    return group.count();
  }
};

TEST_F(Multicast, WhatIsForAllIsOneDatagram) { EXPECT_EQ(tell_two(true, true), 21); }

TEST_F(Multicast, WithoutItEachGetsItsOwn) { EXPECT_EQ(tell_two(false, false), 0); }

TEST_F(Multicast, ARobotWithoutItGetsItsOwn) { EXPECT_EQ(tell_two(true, false), 0); }

TEST_F(QosDirectory, WithoutATimeoutTheBusRunsUntilTheConditionHolds) {
  auto bus = DdsBus::create(config_);
  ASSERT_TRUE(bus);
  int ticks = 0;
  const Handle timer = (*bus)->every(std::chrono::milliseconds(5), [&] { ++ticks; });
  EXPECT_TRUE((*bus)->run_until([&] { return ticks >= 3; }, Duration::max()));
  EXPECT_GE(ticks, 3);
}

}  // namespace
}  // namespace fleetmap::bus::testing
