#include "bus/dds/radio_guard.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "bus/dds/hello.hpp"
#include "bus/dds/lone_radio.hpp"
#include "bus/dds/rtps_header.hpp"
#include "fleetmap/bus/wire_overhead.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::bus::testing {
namespace {

using fleetmap::testing::agent;
using fleetmap::testing::FleetOfKeys;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using trust::Role;

constexpr const char* kFrom = "10.0.0.2:7660";

/// An RTPS message of `guard`'s participant: its header, and `rest`.
Bytes rtps_of(const RadioGuard& guard, const Bytes& rest) {
  Bytes bytes{'R', 'T', 'P', 'S', 2, 2, 1, 15};
  bytes.insert(bytes.end(), guard.session().begin(), guard.session().end());
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}
Bytes without_header(const Bytes& message) { return {message.begin() + kRtpsHeaderBytes, message.end()}; }
Bytes greeting_of(const RadioGuard& guard) {
  return rtps_of(guard, without_header(rtps_message(encode(some_hello()), 1)));
}
Bytes data_of(const RadioGuard& guard) { return rtps_of(guard, Bytes(40, 7)); }

class RadioGuardTest : public ::testing::Test {
 protected:
  /// r1 has heard r2's Hello and found it good.
  void meet() {
    ASSERT_TRUE(r1_.open(r2_.seal(greeting_of(r2_)), kFrom));
    ASSERT_TRUE(r1_.admit(r2_.session(), Role::kRobot));
  }
  static std::vector<std::string> whys(RadioGuard& guard) {
    std::vector<std::string> all;
    for (const auto& stranger : guard.take_strangers()) all.push_back(stranger.address + " " + stranger.why);
    return all;
  }
  static RadioGuard guard(const trust::Credentials& keys, Link link = Link::kLongRange) {
    return {keys, keys.certificate.name, link};
  }

  FleetOfKeys fleet_;
  trust::Credentials keys1_ = fleet_.member("r1"), keys2_ = fleet_.member("r2");
  RadioGuard r1_{keys1_, agent("r1"), Link::kLongRange};
  RadioGuard r2_{keys2_, agent("r2"), Link::kLongRange};
};

TEST_F(RadioGuardTest, ASealedMessageHasNoRtpsHeaderAndGetsItBack) {
  const Bytes sealed = r2_.seal(data_of(r2_));
  EXPECT_EQ(sealed.size(), data_of(r2_).size() + kSealBytes);
  const Bytes greeting = r2_.seal(greeting_of(r2_));
  const Bytes magic{'R', 'T', 'P', 'S'};
  for (const Bytes& datagram : {sealed, greeting})
    EXPECT_EQ(std::search(datagram.begin(), datagram.end(), magic.begin(), magic.end()), datagram.end());
  const auto opened = r1_.open(greeting, kFrom);
  ASSERT_TRUE(opened);
  EXPECT_EQ(without_header(*opened), without_header(greeting_of(r2_)));
  EXPECT_TRUE(std::equal(magic.begin(), magic.end(), opened->begin()));
  EXPECT_TRUE(std::ranges::equal(r2_.session(), ByteView(*opened).subspan(8, 12)));
}

TEST_F(RadioGuardTest, MessagesAreOpenedFromAdmissionToDismissalOnceEach) {
  EXPECT_FALSE(r1_.admit(r2_.session(), Role::kRobot)) << "it has not greeted";
  EXPECT_FALSE(r1_.open(r2_.seal(data_of(r2_)), kFrom)) << "nor was it admitted";
  meet();
  const Bytes sealed = r2_.seal(data_of(r2_));
  const auto opened = r1_.open(sealed, kFrom);
  ASSERT_TRUE(opened);
  EXPECT_EQ(without_header(*opened), without_header(data_of(r2_)));
  EXPECT_FALSE(r1_.open(sealed, kFrom)) << "a replay";
  r1_.dismiss(r2_.session());
  EXPECT_FALSE(r1_.open(r2_.seal(data_of(r2_)), kFrom));
  EXPECT_THAT(r1_.take_strangers(), IsEmpty()) << "none of this is news for an operator";
}

TEST_F(RadioGuardTest, SenderThatIsNotAdmittedMayOnlyGreet) {
  trust::DatagramSealer sealer(keys2_, agent("r2"), static_cast<std::uint8_t>(Link::kLongRange),
                               r2_.session());
  EXPECT_FALSE(r1_.open(sealer.seal(trust::DatagramKind::kGreeting, Bytes(40, 7)), kFrom));
  EXPECT_TRUE(r1_.open(sealer.seal(trust::DatagramKind::kGreeting, without_header(greeting_of(r2_))), kFrom));
}

TEST_F(RadioGuardTest, NoDatagramEndsAsTheTransportWouldOverwriteIt) {
  meet();
  int opened = 0;
  for (int k = 0; k < 2000; ++k) {  // 8 of them would
    const Bytes sealed = r2_.seal(rtps_of(r2_, Bytes(200, static_cast<std::uint8_t>(k))));
    EXPECT_FALSE(ends_like_statistics(sealed));
    opened += r1_.open(sealed, kFrom).has_value();
  }
  EXPECT_EQ(opened, 2000);
}

TEST_F(RadioGuardTest, ARadioIsPartOfTheKey) {
  RadioGuard other = guard(keys2_, Link::kShortRange);
  EXPECT_FALSE(r1_.open(other.seal(greeting_of(other)), kFrom));
}

TEST_F(RadioGuardTest, RobotsWithoutKeysOrWithOthersAreNamedOnce) {
  RadioGuard foreign = guard(FleetOfKeys{}.member("r4"));
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(r1_.open(greeting_of(r2_), kFrom)) << "a Hello that is not sealed";
    EXPECT_FALSE(r1_.open(foreign.seal(greeting_of(foreign)), "10.0.0.4:7660"));
  }
  EXPECT_FALSE(r1_.open(data_of(r2_), kFrom)) << "no Hello: nobody knows who it is";
  EXPECT_THAT(whys(r1_),
              ElementsAre("10.0.0.2:7660 r2 has no keys: give it its folder, and keys: DIR in its file",
                          "10.0.0.4:7660 r4 has the keys of another fleet"));
  EXPECT_THAT(r1_.take_strangers(), IsEmpty());
}

TEST_F(RadioGuardTest, KeysFromBeforeAndAfterARevocationAreToldApart) {
  fleet_.fleet_keys = trust::with_new_epoch(fleet_.fleet_keys);
  const trust::Credentials keys3 = fleet_.member("r3");
  RadioGuard r3 = guard(keys3);
  EXPECT_FALSE(r3.open(r2_.seal(greeting_of(r2_)), kFrom));
  EXPECT_FALSE(r1_.open(r3.seal(greeting_of(r3)), kFrom));
  EXPECT_THAT(whys(r3), ElementsAre("10.0.0.2:7660 r2 has an old key of the fleet (its number 1, ours 2): "
                                    "copy its folder anew"));
  EXPECT_THAT(whys(r1_), ElementsAre("10.0.0.2:7660 r3 has a newer key of the fleet (its number 2, ours 1): "
                                     "copy this robot's folder anew"));
}

TEST_F(RadioGuardTest, DamageUnderAKnownNameIsNamed) {
  Bytes sealed = r2_.seal(greeting_of(r2_));
  sealed.back() ^= 1;
  EXPECT_FALSE(r1_.open(sealed, kFrom));
  EXPECT_THAT(whys(r1_), ElementsAre("10.0.0.2:7660 what comes under the name r2 is forged or damaged"));
}

TEST_F(RadioGuardTest, AFloodOfStrangersIsBounded) {
  for (int k = 0; k < 200; ++k) r1_.open(greeting_of(r2_), "10.0.0.2:" + std::to_string(k));
  EXPECT_EQ(r1_.take_strangers().size(), 64u);
}

}  // namespace
}  // namespace fleetmap::bus::testing
