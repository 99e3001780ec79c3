#include "fleetmap/trust/introduction.hpp"

#include <gmock/gmock.h>

#include "trust/fleet_of_keys.hpp"
#include "trust/payload.hpp"

namespace fleetmap::trust {
namespace {

using testing::agent;
using testing::FleetOfKeys;
using ::testing::HasSubstr;
using testing::kNow;
using testing::kRadio;
using testing::kText;

/// r1 introduces itself to r2.
class Introductions : public ::testing::Test {
 protected:
  Introduction introduce(const Credentials& from, bool with_certificate = true) const {
    return parse_introduction(Introducer(from, kRadio, session_)
                                  .introduce(kText, {.names_you = true}, true, with_certificate))
        .value();
  }
  std::string refusal(const Credentials& from) {
    const auto verified = listener_.verify(introduce(from), session_, kNow);
    return verified ? "none" : verified.error().message;
  }

  FleetOfKeys fleet_;
  Session session_ = draw_session({1, 15});
  Credentials r1_ = fleet_.member("r1"), r2_ = fleet_.member("r2");
  Introducer listener_{r2_, kRadio, draw_session({1, 15})};
};

TEST_F(Introductions, SurviveTheirEncoding) {
  for (int k = 0; k < 32; ++k) {
    const bool sign = (k & 8) != 0, certificate = (k & 16) != 0;
    const Introducer::Flags flags{(k & 1) != 0, (k & 2) != 0, (k & 4) != 0};
    const auto read =
        parse_introduction(Introducer(r1_, kRadio, session_).introduce(kText, flags, sign, certificate));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->text, kText);
    EXPECT_EQ(read->names_you, flags.names_you);
    EXPECT_EQ(read->names_another, flags.names_another);
    EXPECT_EQ(read->lacks_certificate, flags.lacks_certificate);
    EXPECT_EQ(read->fingerprint, fingerprint(r1_.certificate));
    EXPECT_EQ(read->signature.has_value(), sign);
    EXPECT_EQ(read->certificate, certificate ? r1_.certificate.der : Bytes());
  }
}

TEST_F(Introductions, CertificatesThatComeAreKeptForTheItemsOfTheirOwners) {
  EXPECT_TRUE(r2_.learned->all().empty());
  for (int k = 0; k < 2; ++k) EXPECT_TRUE(listener_.verify(introduce(r1_), session_, kNow));
  ASSERT_EQ(r2_.learned->all().size(), 1u);
  EXPECT_EQ(r2_.learned->all()[0].name, agent("r1"));
  EXPECT_EQ(r2_.learned->all()[0].key, r1_.key.public_key());
  EXPECT_EQ(refusal(FleetOfKeys().member("r3")).find("its certificate"), 0u) << "of another fleet";
  EXPECT_EQ(r2_.learned->all().size(), 1u);
}

TEST_F(Introductions, NoPartOfOneProvesAnything) {
  const Bytes whole = Introducer(r1_, kRadio, session_).introduce(kText, {}, true, true);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    const auto part = parse_introduction(ByteView(whole).first(k));  // its last bytes may look like a size
    EXPECT_FALSE(part && listener_.verify(*part, session_, kNow)) << k;
  }
  EXPECT_FALSE(parse_introduction(Bytes(500, 0)));
  EXPECT_FALSE(parse_introduction(Bytes(500, 0xff)));
}

TEST_F(Introductions, AMemberIsWhoItsCertificateSays) {
  const auto verified = listener_.verify(introduce(r1_), session_, kNow);
  ASSERT_TRUE(verified) << verified.error().message;
  EXPECT_EQ(verified->name, agent("r1"));
  EXPECT_EQ(verified->role, Role::kRobot);
}

TEST_F(Introductions, TheCertificateIsNeededOnce) {
  EXPECT_FALSE(listener_.has_certificate(fingerprint(r1_.certificate)));
  EXPECT_THAT(listener_.verify(introduce(r1_, false), session_, kNow).error().message,
              HasSubstr("still to come"));
  EXPECT_TRUE(listener_.verify(introduce(r1_), session_, kNow));
  EXPECT_TRUE(listener_.has_certificate(fingerprint(r1_.certificate)));
  EXPECT_TRUE(listener_.verify(introduce(r1_, false), session_, kNow));
}

TEST_F(Introductions, TheCertificatesInTheFolderNeedNotCome) {
  r2_.members = {r1_.certificate};
  EXPECT_TRUE(Introducer(r2_, kRadio, session_).verify(introduce(r1_, false), session_, kNow));
}

TEST_F(Introductions, NothingSignedMayBeChanged) {
  const Introduction good = introduce(r1_);
  const auto refused = [&](auto change) {
    Introduction changed = good;
    change(changed);
    return !listener_.verify(changed, session_, kNow);
  };
  EXPECT_TRUE(refused([](Introduction& i) { i.text[2] ^= 1; }));
  EXPECT_TRUE(refused([](Introduction& i) { i.names_you = !i.names_you; }));
  EXPECT_TRUE(refused([](Introduction& i) { i.signature->at(5) ^= 1; }));
  EXPECT_TRUE(refused([](Introduction& i) { i.signature.reset(); }));
  EXPECT_FALSE(listener_.verify(good, draw_session({1, 15}), kNow)) << "of another start";
  Introducer other_radio(r2_, kRadio + 1, session_);
  EXPECT_FALSE(other_radio.verify(good, session_, kNow));
  EXPECT_TRUE(listener_.verify(good, session_, kNow));
}

TEST_F(Introductions, AMemberWhoSignsForAnotherIsRefused) {
  Credentials liar = fleet_.member("r3");
  liar.certificate = r1_.certificate;  // known to all, unlike its key
  EXPECT_THAT(refusal(liar), HasSubstr("signature is not that of r1"));
}

TEST_F(Introductions, ExpiredRevokedAndForeignMembersAreRefusedWithTheReason) {
  EXPECT_THAT(refusal(fleet_.member("r4", Role::kRobot, -std::chrono::hours(1))), HasSubstr("r4 expired on"));
  EXPECT_THAT(refusal(FleetOfKeys().member("r1")), HasSubstr("not signed by this fleet's authority"));
  r2_.revocations = {1, {r1_.certificate.serial}};
  r2_.members = {r1_.certificate};
  Introducer updated(r2_, kRadio, session_);
  EXPECT_THAT(updated.verify(introduce(r1_), session_, kNow).error().message, HasSubstr("r1 was revoked"));
  EXPECT_TRUE(updated.was_revoked(agent("r1")));
  EXPECT_FALSE(updated.was_revoked(agent("r2")));
}

TEST_F(Introductions, AnObserverIsOne) {
  const auto verified = listener_.verify(introduce(fleet_.member("o1", Role::kObserver)), session_, kNow);
  ASSERT_TRUE(verified);
  EXPECT_EQ(verified->role, Role::kObserver);
}

}  // namespace
}  // namespace fleetmap::trust
