#include "fleetmap/trust/signing_key.hpp"

#include <gtest/gtest.h>

#include "trust/hex.hpp"

namespace fleetmap::trust {
namespace {

using testing::array_from_hex;

std::string pem_of(const char* name, const char* body) {
  return std::string("-----BEGIN ") + name + "-----\n" + body + "\n-----END " + name + "-----\n";
}

constexpr const char* kPrivate = "PRIVATE KEY";
/// RFC 8032, section 7.1: test 1 (no message) and test 2 (message 72).
const std::string kFirstPem =
    pem_of(kPrivate, "MC4CAQAwBQYDK2VwBCIEIJ1hsZ3v/VpguoRK9JLsLMREScVpezJpGXA7rAMcrn9g");
const std::string kSecondPem =
    pem_of(kPrivate, "MC4CAQAwBQYDK2VwBCIEIEzNCJso/5banbbDRuwRTg9bijGfNaumJNqM9u1PuKb7");
const PublicKey kFirstPublic =
    array_from_hex<32>("d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a");
const PublicKey kSecondPublic =
    array_from_hex<32>("3d4017c3e843895a92b70aa74d1b7ebc9c982ccf2ec4968cc0cd55f12af4660c");
const Signature kFirstSignature = array_from_hex<64>(
    "e5564300c360ac729086e2cc806e828a84877f1eb8e5d974d873e065224901555fb8821590a33bacc61e39701cf9b46b"
    "d25bf5f0595bbe24655141438e7a100b");
const Signature kSecondSignature = array_from_hex<64>(
    "92a009a9f0d4cab8720e820b5f642540a2b27b5416503f8fb3762223ebdb69da085ac1e43e15996e458f3613d0f11d8c"
    "387b2eaeb4302aeeb00d291612bb0c00");

TEST(SigningKey, SignsAsThePublishedExamplesDo) {
  const auto first = SigningKey::from_pem(kFirstPem), second = SigningKey::from_pem(kSecondPem);
  ASSERT_TRUE(first) << first.error().message;
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(first->public_key(), kFirstPublic);
  EXPECT_EQ(second->public_key(), kSecondPublic);
  EXPECT_EQ(first->sign({}), kFirstSignature);
  EXPECT_EQ(second->sign(Bytes{0x72}), kSecondSignature);
  EXPECT_TRUE(verify(kFirstPublic, {}, kFirstSignature));
  EXPECT_TRUE(verify(kSecondPublic, Bytes{0x72}, kSecondSignature));
}

TEST(SigningKey, ASignatureIsOfOneKeyAndOneMessage) {
  EXPECT_FALSE(verify(kSecondPublic, {}, kFirstSignature));
  EXPECT_FALSE(verify(kSecondPublic, Bytes{0x73}, kSecondSignature));
  EXPECT_FALSE(verify(kSecondPublic, Bytes{0x72, 0}, kSecondSignature));
  for (std::size_t bit = 0; bit < 512; ++bit) {
    Signature damaged = kSecondSignature;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    EXPECT_FALSE(verify(kSecondPublic, Bytes{0x72}, damaged)) << bit;
  }
  EXPECT_FALSE(verify({}, Bytes{0x72}, kSecondSignature));
}

TEST(SigningKey, ItsFileKeepsTheKey) {
  EXPECT_EQ(SigningKey::from_pem(kFirstPem)->to_pem(), kFirstPem);
  const SigningKey made = SigningKey::generate();
  const auto read = SigningKey::from_pem(made.to_pem());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->public_key(), made.public_key());
  EXPECT_TRUE(verify(made.public_key(), Bytes{1, 2}, read->sign(Bytes{1, 2})));
  EXPECT_NE(SigningKey::generate().public_key(), made.public_key());
}

TEST(SigningKey, AnythingElseIsRefused) {
  const std::string x25519 =
      pem_of(kPrivate, "MC4CAQAwBQYDK2VuBCIEIEzNCJso/5banbbDRuwRTg9bijGfNaumJNqM9u1PuKb7");
  // Its passphrase is "secret", for which nobody may be asked.
  const std::string encrypted = pem_of("ENCRYPTED PRIVATE KEY",
                                       "MIGbMFcGCSqGSIb3DQEFDTBKMCkGCSqGSIb3DQEFDDAcBAi2Qzm7vKYStwICCAAw\n"
                                       "DAYIKoZIhvcNAgkFADAdBglghkgBZQMEASoEEAEL1o/zkMJ4NqL4//g8f/sEQDKY\n"
                                       "d6iuc67sPjJOrwHTbqWe+dRHDlDYTCG0KNbgUcPr7ljJko9G3fg7RliPBBjQm93B\n"
                                       "F11XmaimzVcn0gZTaig=");
  for (const std::string& text : {std::string(), std::string("nonsense\n"), kFirstPem.substr(0, 60),
                                  pem_of("CERTIFICATE", "MC4CAQAwBQYDK2Vw"), x25519, encrypted}) {
    const auto key = SigningKey::from_pem(text);
    ASSERT_FALSE(key) << text;
    EXPECT_EQ(key.error().message, "is no Ed25519 private key in PEM");
  }
}

}  // namespace
}  // namespace fleetmap::trust
