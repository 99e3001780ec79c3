#include "fleetmap/trust/certificate.hpp"

#include <gmock/gmock.h>

#include "trust/fleet_of_keys.hpp"

namespace fleetmap::trust {
namespace {

using testing::agent;
using testing::FleetOfKeys;
using ::testing::HasSubstr;
using testing::kNow;

TEST(SigningKey, VerifiesWhatItSignedAndNothingElse) {
  const SigningKey key = SigningKey::generate();
  const Bytes message{1, 2, 3};
  Signature signature = key.sign(message);
  EXPECT_TRUE(verify(key.public_key(), message, signature));
  EXPECT_FALSE(verify(SigningKey::generate().public_key(), message, signature));
  EXPECT_FALSE(verify(key.public_key(), Bytes{1, 2, 4}, signature));
  signature[63] ^= 1;
  EXPECT_FALSE(verify(key.public_key(), message, signature));
}

TEST(SigningKey, SurvivesPem) {
  const SigningKey key = SigningKey::generate();
  EXPECT_EQ(SigningKey::from_pem(key.to_pem())->public_key(), key.public_key());
  EXPECT_FALSE(SigningKey::from_pem("-----BEGIN PRIVATE KEY-----\n"));
}

TEST(Certificate, SurvivesItsEncoding) {
  FleetOfKeys fleet;
  for (const Role role : {Role::kRobot, Role::kObserver}) {
    const Certificate made = fleet.member("r1", role).certificate;
    const auto read = parse_certificate(made.der, fleet.authority);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->name, agent("r1"));
    EXPECT_EQ(read->role, role);
    EXPECT_EQ(read->serial, made.serial);
    EXPECT_EQ(read->key, made.key);
    EXPECT_EQ(read->not_after, made.not_after);
    EXPECT_EQ(fingerprint(*read), fingerprint(made));
  }
}

TEST(Certificate, FitsTwiceIntoADatagram) {
  EXPECT_LT(FleetOfKeys().member("r1").certificate.der.size(), 300u);
}

TEST(Certificate, NoChangedByteIsAccepted) {
  FleetOfKeys fleet;
  const Bytes der = fleet.member("r1").certificate.der;
  for (std::size_t k = 0; k < der.size(); ++k) {
    Bytes changed = der;
    changed[k] ^= 0x10;
    EXPECT_FALSE(parse_certificate(changed, fleet.authority)) << "byte " << k;
    EXPECT_FALSE(parse_certificate(ByteView(der).first(k), fleet.authority));
  }
}

TEST(Certificate, OfAnotherAuthorityIsRefused) {
  FleetOfKeys ours, theirs;
  const auto read = parse_certificate(theirs.member("r1").certificate.der, ours.authority);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("not signed by this fleet's authority"));
}

TEST(Certificate, OfAMemberIsNoAuthority) {
  EXPECT_FALSE(parse_authority(FleetOfKeys().member("r1").certificate.der));
  const FleetOfKeys fleet;
  EXPECT_EQ(parse_authority(fleet.authority.der)->fleet, fleet.authority.fleet);
}

TEST(Certificate, IsValidFromTheFirstToTheLastDateAndNotOnceRevoked) {
  FleetOfKeys fleet;
  const Certificate made = fleet.member("r1").certificate;
  EXPECT_TRUE(check(made, {}, kNow));
  EXPECT_THAT(check(made, {}, made.not_after + std::chrono::seconds(1)).error().message,
              HasSubstr("of r1 expired on " + date(made.not_after)));
  EXPECT_THAT(check(made, {}, made.not_before - std::chrono::seconds(1)).error().message,
              HasSubstr("this machine's clock says"));
  EXPECT_THAT(check(made, {1, {made.serial}}, kNow).error().message, HasSubstr("was revoked"));
  EXPECT_TRUE(check(made, {1, {made.serial + 1}}, kNow));
}

TEST(Revocations, SurviveTheirEncodingAndAreTheAuthoritysAlone) {
  const FleetOfKeys fleet, other;
  const Bytes der = sign_revocations(fleet.authority, fleet.key, {7, {3, 4'000'000'000}}, kNow);
  const auto read = parse_revocations(der, fleet.authority);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->number, 7u);
  EXPECT_EQ(read->serials, (std::set<std::uint32_t>{3, 4'000'000'000}));
  EXPECT_FALSE(parse_revocations(der, other.authority));
  Bytes changed = der;
  changed[der.size() / 2] ^= 1;
  EXPECT_FALSE(parse_revocations(changed, fleet.authority));
}

}  // namespace
}  // namespace fleetmap::trust
