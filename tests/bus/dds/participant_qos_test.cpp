#include "bus/dds/participant_qos.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <gmock/gmock.h>

#include <cmath>

#include "bus/dds/rtps_messages.hpp"

namespace fleetmap::bus {
namespace {

using eprosima::fastdds::dds::DomainParticipantQos;
using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const AgentId kRobot = AgentId::parse("r1").value();

/// A profile with shared memory and UDP.
struct Profile {
  Profile() {
    shared->segment_size(1 << 20);
    qos.transport().user_transports = {shared, udp};
  }
  std::shared_ptr<SharedMemTransportDescriptor> shared = std::make_shared<SharedMemTransportDescriptor>();
  std::shared_ptr<UDPv4TransportDescriptor> udp = std::make_shared<UDPv4TransportDescriptor>();
  DomainParticipantQos qos;
};

template <class Locators>
std::vector<std::string> texts(const Locators& locators) {
  std::vector<std::string> all;
  for (const auto& locator : locators) all.push_back(to_text(locator));
  return all;
}

std::vector<std::string> places(const DdsLinkConfig& config) {
  return texts(listening_places(config, Profile().qos));
}

TEST(ListeningPlaces, RemotePeersHaveTheFirstPortOfTheDomain) {
  DdsLinkConfig config;
  config.domain = 3;  // RTPS: 7400 + 250 a domain + 10, + 2 a participant
  config.address = "10.0.0.1";
  config.peers = {"10.0.0.2", "10.0.0.3:7500"};
  EXPECT_THAT(places(config), ElementsAre("10.0.0.2:8160", "10.0.0.3:7500"));
  config.participants_per_peer = 2;
  EXPECT_THAT(places(config), ElementsAre("10.0.0.2:8160", "10.0.0.2:8162", "10.0.0.3:7500"));
}

TEST(ListeningPlaces, PeersOfThisMachineHaveManyPorts) {
  DdsLinkConfig config;
  const auto here = places(config);
  ASSERT_EQ(here.size(), 16u);
  EXPECT_EQ(here.front(), "127.0.0.1:7410");
  EXPECT_EQ(here.back(), "127.0.0.1:7440");
  config.address = "10.0.0.1";
  config.peers = {"10.0.0.1"};
  EXPECT_EQ(places(config).size(), 16u) << "the own address is this machine as well";
}

TEST(ListeningPlaces, InOtherDomainsAreFewer) {
  DdsLinkConfig config;
  config.domain = 1;
  config.address = "10.0.0.1";
  config.peers = {"10.0.0.2"};
  config.other_domains = {0, 1, 4};
  EXPECT_THAT(places(config), ElementsAre("10.0.0.2:7660", "10.0.0.2:7410", "10.0.0.2:8410"));
  config.peers = {"127.0.0.1"};
  config.other_domains = {4};
  const auto here = places(config);
  ASSERT_EQ(here.size(), 20u);
  EXPECT_EQ(here[16], "127.0.0.1:8410");
  EXPECT_EQ(here[19], "127.0.0.1:8416");
}

TEST(DomainOf, APortIsTheInverseOfItsPorts) {
  const DomainParticipantQos qos;
  for (const std::uint32_t domain : {0u, 1u, 42u, 230u}) {
    EXPECT_EQ(domain_of(7410 + 250 * domain, qos), domain);
    EXPECT_EQ(domain_of(7410 + 250 * domain + 32, qos), domain) << "its 17th participant";
  }
  EXPECT_EQ(domain_of(80, qos), 0u);
}

TEST(RadioAttributes, AreOfAParticipantWithoutDiscoveryOnTheOwnAddress) {
  const Profile profile;
  DdsLinkConfig config;
  config.domain = 2;
  config.address = "10.0.0.1";
  const auto robot = radio_attributes(config, Link::kLongRange, kRobot, false, profile.qos);
  EXPECT_STREQ(robot.getName(), "fleetmap/r1/long_range");
  EXPECT_EQ(robot.builtin.discovery_config.discoveryProtocol,
            eprosima::fastrtps::rtps::DiscoveryProtocol_t::NONE);
  EXPECT_FALSE(robot.builtin.use_WriterLivelinessProtocol);
  EXPECT_FALSE(robot.useBuiltinTransports);
  EXPECT_THAT(texts(robot.defaultUnicastLocatorList), ElementsAre("0.0.0.0:7910"));
  ASSERT_EQ(robot.userTransports.size(), 2u);
  const auto udp = std::dynamic_pointer_cast<UDPv4TransportDescriptor>(robot.userTransports[1]);
  ASSERT_TRUE(udp);
  EXPECT_THAT(udp->interfaceWhiteList, ElementsAre("10.0.0.1"));
  EXPECT_TRUE(profile.udp->interfaceWhiteList.empty()) << "others use the profile's descriptor too";
  const auto observer = radio_attributes(config, Link::kLongRange, kRobot, true, profile.qos);
  EXPECT_THAT(texts(observer.defaultUnicastLocatorList), ElementsAre("0.0.0.0:7912"));
  EXPECT_NE(observer.participantID, robot.participantID) << "each start takes another number";
}

TEST(ApplyOnboard, TheLoopbackAndItsGroupAreAlwaysSought) {
  Profile profile;
  DdsLinkConfig config;
  config.domain = 5;
  config.peers = {"127.0.0.1:9000"};
  apply_onboard(config, kRobot, profile.qos);
  EXPECT_EQ(profile.qos.name().to_string(), "fleetmap/r1/onboard");
  const auto& wire = profile.qos.wire_protocol();
  EXPECT_THAT(texts(wire.builtin.metatrafficUnicastLocatorList), ElementsAre("0.0.0.0:8660"));
  EXPECT_THAT(texts(wire.builtin.metatrafficMulticastLocatorList), ElementsAre("239.255.0.1:8650"));
  EXPECT_THAT(texts(wire.builtin.initialPeersList), ElementsAre("127.0.0.1:9000", "239.255.0.1:8650"));
  EXPECT_GE(wire.participant_id, 16);
  EXPECT_LT(wire.participant_id, 116) << "ports of the next domain begin at 120";
  EXPECT_EQ(shared_memory_bytes(profile.qos), 1u << 20);
}

TEST(ApplyOnboard, PeersOfTheProfileStayUnlessOthersAreGiven) {
  Profile profile;
  eprosima::fastrtps::rtps::Locator_t peer;
  peer.port = 9000;
  profile.qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  apply_onboard({}, kRobot, profile.qos);
  EXPECT_THAT(texts(profile.qos.wire_protocol().builtin.initialPeersList), ElementsAre(HasSubstr(":9000")));
}

TEST(ApplyOnboard, SharedMemoryCanBeLeftOut) {
  Profile profile;
  apply_onboard({.shared_memory = false}, kRobot, profile.qos);
  EXPECT_EQ(profile.qos.transport().user_transports.size(), 1u);
  EXPECT_EQ(shared_memory_bytes(profile.qos), 0u);
}

TEST(ValidateLink, NamesTheFieldThatIsWrong) {
  const auto error = [](auto&& change) {
    DdsLinkConfig config;
    change(config);
    const Status status = validate(config, "short_range");
    return status ? std::string("none") : status.error().message;
  };
  EXPECT_EQ(error([](auto& c) { c.domain = 230; }), "none");
  EXPECT_EQ(error([](auto& c) { c.domain = 231; }), "short_range.domain is 231; must be in [0, 230]");
  EXPECT_EQ(error([](auto& c) {
              c.other_domains = {3, 300};
            }),
            "short_range.other_domains has 300; at most 230");
  EXPECT_EQ(error([](auto& c) { c.peers = {"127.0.0.1:65535"}; }), "none");
  for (const char* peer : {"10.0.0", "10.0.0.2:", "10.0.0.2:65536", "10.0.0.2:0", "10.0.0.2:7x", "robot2"}) {
    EXPECT_EQ(error([&](auto& c) { c.peers = {peer}; }),
              "short_range.peers has \"" + std::string(peer) + "\"; must be ADDRESS or ADDRESS:PORT, IPv4");
  }
  EXPECT_THAT(error([](auto& c) { c.peers = {"10.0.0.2"}; }),
              HasSubstr("address is not set, but 10.0.0.2 is another machine"));
  EXPECT_EQ(error([](auto& c) { c.peers = {"10.0.0.2"}, c.address = "10.0.0.1"; }), "none");
  EXPECT_EQ(error([](auto& c) { c.fleet_bits_per_second = std::nan(""); }),
            "short_range.fleet_bits_per_second must be > 0");
  EXPECT_EQ(error([](auto& c) { c.queue_messages = 0; }), "short_range.queue_messages must be > 0");
  EXPECT_EQ(error([](auto& c) { c.queue_bytes = 0; }), "short_range.queue_bytes must be > 0");
}

TEST(ValidateLink, OnboardOtherMachinesNeedNoAddress) {
  DdsLinkConfig config;
  config.peers = {"10.0.0.2"};
  EXPECT_TRUE(validate(config, "onboard"));
}

TEST(CheckAddress, IsOfThisMachine) {
  DdsLinkConfig config;
  EXPECT_TRUE(check_address(config, "long_range")) << "none is asked for";
  config.address = "127.0.0.1";
  EXPECT_TRUE(check_address(config, "long_range"));
  config.address = "203.0.113.77";  // TEST-NET-3
  const Status status = check_address(config, "long_range");
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message,
              AllOf(HasSubstr("long_range.address: no interface of this machine has 203.0.113.77"),
                    HasSubstr("lo 127.0.0.1")));
}

}  // namespace
}  // namespace fleetmap::bus
