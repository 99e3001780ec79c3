#include "bus/dds/radio_link.hpp"

#include <gmock/gmock.h>

#include "bus/dds/lone_radio.hpp"
#include "bus/qos_directory.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::HasSubstr;

TEST_F(QosDirectory, AReliableRadioIsRefusedSinceItsRepairsHaveNoEnd) {
  replace("short_range.xml", "<kind>BEST_EFFORT</kind>", "<kind>RELIABLE</kind>");
  EXPECT_THAT(error(), HasSubstr("<data_writer> \"control\" is reliable; short_range is best effort"));
}

/// r1 on the loopback, which is told of robots at addresses that the test makes up.
class RadioLinkTest : public LoneRadio {
 protected:
  void SetUp() override { bus_ = &start(robot("r1")); }
  /// A Hello of `agent` that claims to come from there.
  void announce(const char* agent, std::array<std::uint8_t, 4> address, std::uint16_t port) {
    Hello hello = some_hello();
    hello.link = Link::kLongRange;
    hello.sender = name(agent);
    hello.address = address;
    hello.port = port;
    ++sent_;
    send_to(own_, rtps_message(encode(hello), static_cast<std::uint8_t>(sent_),
                               static_cast<std::uint8_t>(1 + sent_ % 250)));
  }

  DdsBus* bus_ = nullptr;
  const std::uint16_t own_ = static_cast<std::uint16_t>(7410 + 250 * first_test_domain());
  int sent_ = 0;
};

/// An answer to these would go to the whole group, to this robot itself or to a network that the link has
/// not.
TEST_F(RadioLinkTest, NoRobotIsSoughtWhereNoneCanListen) {
  announce("r2", {239, 255, 0, 1}, own_);
  announce("r3", {0, 0, 0, 0}, own_);
  announce("r4", {10, 1, 2, 3}, own_);
  announce("r5", {127, 0, 0, 1}, own_);
  ASSERT_TRUE(run_until([&] {
    announce("r6", {127, 0, 0, 1}, static_cast<std::uint16_t>(own_ + 2));
    return heard(*bus_) == 1;
  })) << log_.text();
  EXPECT_EQ(bus_->survey(Link::kLongRange).robots[0].agent, name("r6"));
  EXPECT_EQ(log_.count("heard r"), 1) << log_.text();
}

/// Each address has a writer of its own, so strangers could fill the memory with them.
TEST_F(RadioLinkTest, StrangersAddAddressesUpToABound) {
  const std::size_t configured = bus_->survey(Link::kLongRange).places;
  std::uint16_t port = 20'000;
  // One Hello of many processed in a tick; a robot that is heard last shows that all before were processed.
  for (int round = 0; round < 3; ++round) {
    for (int k = 0; k < 120; ++k) announce("x", {127, 0, 0, 1}, ++port);
    const std::size_t before = bus_->survey(Link::kLongRange).places;
    run_until([&] {
      const std::size_t places = bus_->survey(Link::kLongRange).places;
      return places >= std::min<std::size_t>(256, before + 100);
    });
  }
  const std::size_t places = bus_->survey(Link::kLongRange).places;
  EXPECT_GT(places, configured);
  EXPECT_EQ(places, 256u);
}

/// Others need not wait for the lease of a robot whose program ends.
TEST_F(RadioLinkTest, ALinkThatEndsLeaves) {
  start(robot("r2"));
  ASSERT_TRUE(run_until([&] { return log_.count("heard r2") == 1 && log_.count("heard r1") == 1; }));
  const Topic topic{Link::kLongRange, "t", "T", "small"};
  const Handle reads = buses_.back()->subscribe(topic, [](const Bytes&) {});
  bus_->advertise(topic);
  ASSERT_TRUE(run_until([&] { return bus_->matches(topic).readers == 1; }));
  buses_.pop_back();
  EXPECT_TRUE(run_until([&] { return bus_->matches(topic).readers == 0; }));
  EXPECT_EQ(log_.count("r2 leaves"), 1) << log_.text();
  EXPECT_EQ(log_.count("nothing heard from"), 0) << "the lease had not to end";
}

}  // namespace
}  // namespace fleetmap::bus::testing
