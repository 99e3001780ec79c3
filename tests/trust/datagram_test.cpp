#include "fleetmap/trust/datagram.hpp"

#include <gmock/gmock.h>

#include "trust/fleet_of_keys.hpp"
#include "trust/payload.hpp"

namespace fleetmap::trust {
namespace {

using testing::agent;
using testing::FleetOfKeys;
using testing::kRadio;
using testing::kText;
using Why = NotOpened::Why;

/// r1 sends, r2 hears.
class Datagram : public ::testing::Test {
 protected:
  DatagramSealer sealer(const Credentials& of, const Session& session, std::uint8_t radio = kRadio) const {
    return {of, of.certificate.name, radio, session};
  }
  /// r2 has taken r1's greeting.
  void meet(Role role = Role::kRobot) {
    ASSERT_TRUE(heard_.open(sent_.seal(DatagramKind::kGreeting, kText)));
    ASSERT_TRUE(heard_.admit(session_, role));
  }
  Bytes message() { return sent_.seal(DatagramKind::kMessage, kText); }
  Why why_not(const Bytes& datagram) {
    const auto opened = heard_.open(datagram);
    EXPECT_FALSE(opened);
    return opened ? Why::kNotSealed : opened.error().why;
  }

  FleetOfKeys fleet_;
  Credentials r1_ = fleet_.member("r1"), r2_ = fleet_.member("r2");
  Session session_ = draw_session({1, 15});
  DatagramSealer sent_ = sealer(r1_, session_);
  DatagramOpener heard_{r2_, kRadio};
};

TEST_F(Datagram, IsOpenedAsItWasSealed) {
  const auto greeting = heard_.open(sent_.seal(DatagramKind::kGreeting, kText));
  ASSERT_TRUE(greeting);
  EXPECT_EQ(greeting->message, kText);
  EXPECT_EQ(greeting->session, session_);
  ASSERT_TRUE(heard_.admit(session_, Role::kRobot));
  for (const std::size_t size : {0, 1, 1400}) {
    const Bytes text(size, 7);
    const Bytes sealed = sent_.seal(DatagramKind::kMessage, text);
    EXPECT_EQ(sealed.size(), size + kMessageHeaderBytes + kTagBytes);
    const auto opened = heard_.open(sealed);
    ASSERT_TRUE(opened) << size;
    EXPECT_EQ(opened->message, text);
    EXPECT_EQ(opened->session, session_);
  }
}

TEST_F(Datagram, HidesItsText) {
  const Bytes sealed = message();
  EXPECT_EQ(std::search(sealed.begin(), sealed.end(), kText.begin(), kText.end()), sealed.end());
}

TEST_F(Datagram, NoChangedOrMissingByteIsAccepted) {
  meet();
  for (const DatagramKind kind : {DatagramKind::kMessage, DatagramKind::kGreeting}) {
    const Bytes sealed = sent_.seal(kind, kText);
    for (std::size_t k = 0; k < sealed.size(); ++k) {
      for (const std::uint8_t bit : std::initializer_list<std::uint8_t>{1, 0x80}) {
        Bytes changed = sealed;
        changed[k] ^= bit;
        EXPECT_FALSE(heard_.open(changed)) << "byte " << k;
      }
      EXPECT_FALSE(heard_.open(ByteView(sealed).first(k)));
    }
    EXPECT_TRUE(heard_.open(sealed)) << "what was tried in vain does not use up the counter";
  }
}

TEST_F(Datagram, AMessageIsOpenedOnceInAnyOrder) {
  meet();
  const Bytes first = message(), second = message();
  EXPECT_TRUE(heard_.open(second));
  EXPECT_TRUE(heard_.open(first));
  EXPECT_EQ(why_not(first), Why::kReplayed);
  EXPECT_EQ(why_not(second), Why::kReplayed);
}

TEST_F(Datagram, NobodyIsHeardBeforeItIsAdmitted) {
  EXPECT_EQ(why_not(message()), Why::kUnknown);
  EXPECT_FALSE(heard_.admit(session_, Role::kRobot)) << "without a greeting";
  ASSERT_TRUE(heard_.open(sent_.seal(DatagramKind::kGreeting, kText)));
  EXPECT_EQ(why_not(message()), Why::kUnknown);
}

TEST_F(Datagram, DatagramsSealedBeforeTheGreetingAreRefusedAfterIt) {
  const Bytes yesterday = message();
  meet();
  EXPECT_EQ(why_not(yesterday), Why::kReplayed);
  EXPECT_TRUE(heard_.open(message()));
}

TEST_F(Datagram, OfAnEarlierStartOfTheSenderIsUnknown) {
  const Session earlier = draw_session({1, 15});
  DatagramSealer before = sealer(r1_, earlier);
  const Bytes greeting = before.seal(DatagramKind::kGreeting, kText);
  const Bytes message = before.seal(DatagramKind::kMessage, kText);
  meet();
  EXPECT_TRUE(heard_.open(greeting)) << "it is a claim, to be proved";
  EXPECT_EQ(why_not(message), Why::kUnknown);
  EXPECT_EQ(why_not(greeting), Why::kReplayed);
}

TEST_F(Datagram, AReplayIsRefusedAlsoWhenTheSenderWasDismissedMeanwhile) {
  meet();
  const Bytes before = message(), greeting = sent_.seal(DatagramKind::kGreeting, kText);
  EXPECT_TRUE(heard_.open(before));
  EXPECT_TRUE(heard_.open(greeting));
  heard_.dismiss(session_);
  EXPECT_EQ(why_not(message()), Why::kUnknown);
  EXPECT_EQ(why_not(greeting), Why::kReplayed);
  ASSERT_TRUE(heard_.admit(session_, Role::kRobot));
  EXPECT_EQ(why_not(before), Why::kReplayed);
  EXPECT_TRUE(heard_.open(message()));
}

TEST_F(Datagram, OfTheOtherRadioIsRefused) {
  DatagramOpener other(r2_, kRadio + 1);
  EXPECT_EQ(other.open(sent_.seal(DatagramKind::kGreeting, kText)).error().why, Why::kForged);
}

TEST_F(Datagram, OfAnotherFleetIsNamed) {
  FleetOfKeys others;
  const auto opened = heard_.open(sealer(others.member("r9"), session_).seal(DatagramKind::kGreeting, kText));
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().why, Why::kOtherFleet);
  EXPECT_EQ(opened.error().name, agent("r9"));
}

TEST_F(Datagram, OfThisFleetsNameWithoutItsKeyIsForged) {
  Credentials liar = r1_;
  liar.fleet_keys = with_new_epoch({});
  EXPECT_EQ(why_not(sealer(liar, session_).seal(DatagramKind::kGreeting, kText)), Why::kForged);
}

TEST_F(Datagram, OfAnEarlierEpochIsNamedAndOfALaterOneToo) {
  Credentials next = r2_;
  next.fleet_keys = with_new_epoch(r2_.fleet_keys);
  DatagramOpener updated(next, kRadio);
  const auto old = updated.open(sent_.seal(DatagramKind::kGreeting, kText));
  ASSERT_FALSE(old);
  EXPECT_EQ(old.error().why, Why::kOldEpoch);
  EXPECT_EQ(old.error().name, agent("r1"));
  const auto later = heard_.open(sealer(next, session_).seal(DatagramKind::kGreeting, kText));
  ASSERT_FALSE(later);
  EXPECT_EQ(later.error().why, Why::kNewEpoch);
  EXPECT_EQ(later.error().epoch, 2);
}

TEST_F(Datagram, AnObserverGreetsAndSaysNothing) {
  meet(Role::kObserver);
  EXPECT_EQ(why_not(message()), Why::kReadsOnly);
  EXPECT_TRUE(heard_.open(sent_.seal(DatagramKind::kGreeting, kText)));
}

TEST_F(Datagram, PlainRtpsIsNotSealed) {
  EXPECT_EQ(why_not({'R', 'T', 'P', 'S', 2, 2}), Why::kNotSealed);
  EXPECT_EQ(why_not({}), Why::kNotSealed);
}

TEST(Session, IsAnotherEachTime) {
  const Session first = draw_session({1, 15}), second = draw_session({1, 15});
  EXPECT_NE(first, second);
  EXPECT_EQ(first[0], 1);
  EXPECT_EQ(first[1], 15);
}

}  // namespace
}  // namespace fleetmap::trust
