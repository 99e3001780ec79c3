#include "fleetmap/trust/cipher.hpp"

#include <gtest/gtest.h>

#include <set>

#include "trust/hex.hpp"

namespace fleetmap::trust {
namespace {

using testing::array_from_hex;
using testing::from_hex;

const Bytes kHeader{1, 2, 3};

SecretKey key_of(std::uint8_t first) {
  SecretKey key{};
  for (std::size_t k = 0; k < key.size(); ++k) key[k] = static_cast<std::uint8_t>(first + k);
  return key;
}

Bytes sealed(Cipher& cipher, std::uint64_t counter, const Bytes& message, Bytes header = kHeader) {
  cipher.seal(counter, header, message);
  return header;
}

std::optional<Bytes> opened(Cipher& cipher, std::uint64_t counter, const Bytes& datagram) {
  const ByteView all(datagram);
  return cipher.open(counter, all.first(kHeader.size()), all.subspan(kHeader.size()));
}

/// RFC 8439, appendix A.5.
TEST(Cipher, OpensAndSealsThePublishedExample) {
  Cipher cipher(array_from_hex<32>("1c9240a5eb55d38af333888604f6b5f0473917c1402b80099dca5cbc207075c0"));
  const std::uint64_t counter = 0x0102030405060708;
  const Bytes header = from_hex("f33388860000000000004e91");
  const Bytes text = from_hex(
      "64a0861575861af460f062c79be643bd5e805cfd345cf389f108670ac76c8cb24c6cfc18755d43eea09ee94e382d26b0"
      "bdb7b73c321b0100d4f03b7f355894cf332f830e710b97ce98c8a84abd0b948114ad176e008d33bd60f982b1ff37c855"
      "9797a06ef4f0ef61c186324e2b3506383606907b6a7c02b0f9f6157b53c867e4b9166c767b804d46a59b5216cde7a4e9"
      "9040c5a40433225ee282a1b0a06c523eaf4534d7f83fa1155b0047718cbc546a0d072b04b3564eea1b422273f548271a"
      "0bb2316053fa76991955ebd63159434ecebb4e466dae5a1073a6727627097a1049e617d91d361094fa68f0ff77987130"
      "305beaba2eda04df997b714d6c6f2c29a6ad5cb4022b02709beead9d67890cbb22392336fea1851f38");
  const auto message = cipher.open(counter, header, text);
  ASSERT_TRUE(message);
  EXPECT_EQ(
      std::string(message->begin(), message->end()),
      "Internet-Drafts are draft documents valid for a maximum of six months and may be updated, replaced, "
      "or obsoleted by other documents at any time. It is inappropriate to use Internet-Drafts as "
      "reference material or to cite them other than as /\xe2\x80\x9cwork in progress./\xe2\x80\x9d");
  Bytes again = header;
  cipher.seal(counter, again, *message);
  Bytes expected = header;
  expected.insert(expected.end(), text.begin(), text.end());
  EXPECT_EQ(again, expected);
}

TEST(Cipher, MessagesOfAllLengthsComeBack) {
  Cipher sender(key_of(1)), receiver(key_of(1));
  for (const std::size_t size : {0u, 1u, 15u, 16u, 17u, 64u, 1400u, 65000u}) {
    const Bytes message(size, 0x5a);
    const Bytes datagram = sealed(sender, size, message);
    ASSERT_EQ(datagram.size(), kHeader.size() + size + kTagBytes);
    EXPECT_EQ(Bytes(datagram.begin(), datagram.begin() + 3), kHeader);
    EXPECT_EQ(opened(receiver, size, datagram), message) << size;
  }
}

TEST(Cipher, NothingOpensThatIsNotAsItWasSealed) {
  Cipher sender(key_of(1)), receiver(key_of(1)), stranger(key_of(2));
  const Bytes message{10, 20, 30, 40};
  const Bytes good = sealed(sender, 7, message);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes damaged = good;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    EXPECT_FALSE(opened(receiver, 7, damaged)) << bit;
  }
  for (std::size_t size = kHeader.size(); size < good.size(); ++size)
    EXPECT_FALSE(opened(receiver, 7, Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))));
  EXPECT_FALSE(opened(receiver, 8, good));
  EXPECT_FALSE(opened(receiver, 7 + (std::uint64_t{1} << 56), good)) << "the highest byte counts, too";
  EXPECT_FALSE(opened(stranger, 7, good));
  EXPECT_EQ(opened(receiver, 7, good), message) << "after all that";
}

TEST(Cipher, EachCounterHidesTheSameMessageAnew) {
  Cipher cipher(key_of(1));
  const Bytes message(40, 0);
  std::set<Bytes> texts;
  for (std::uint64_t counter = 0; counter < 100; ++counter) texts.insert(sealed(cipher, counter, message));
  EXPECT_EQ(texts.size(), 100u);
}

TEST(CipherSession, IsDrawnAnewBehindItsFirstBytes) {
  std::set<Session> drawn;
  for (int k = 0; k < 100; ++k) drawn.insert(draw_session({1, 15}));
  EXPECT_EQ(drawn.size(), 100u);
  for (std::size_t byte = 0; byte < sizeof(Session); ++byte) {
    std::set<std::uint8_t> values;
    for (const Session& session : drawn) values.insert(session[byte]);
    EXPECT_EQ(values.size() == 1, byte < 2) << byte;
  }
  EXPECT_EQ((*drawn.begin())[0], 1);
  EXPECT_EQ((*drawn.begin())[1], 15);
}

/// RFC 5869 with SHA-256: salt is the session; info "fleetmap radio 1", fleet, epoch, radio. Computed with
/// Python's hmac.
TEST(CipherSession, TheKeyOfASessionIsThatOfTheProtocol) {
  FleetId fleet{};
  for (std::size_t k = 0; k < fleet.size(); ++k) fleet[k] = static_cast<std::uint8_t>(0xa0 + k);
  Session session{};
  for (std::size_t k = 0; k < session.size(); ++k) session[k] = static_cast<std::uint8_t>(0x50 + k);
  const SecretKey key = session_key(key_of(0), fleet, 0x0102, 3, session);
  EXPECT_EQ(key, array_from_hex<32>("a6b4a537f1b3a94f892427bcac6deccb76d76152ee0f5cf69bec5e611c547cd7"));
  EXPECT_NE(session_key(key_of(1), fleet, 0x0102, 3, session), key);
  EXPECT_NE(session_key(key_of(0), {}, 0x0102, 3, session), key);
  EXPECT_NE(session_key(key_of(0), fleet, 0x0103, 3, session), key);
  EXPECT_NE(session_key(key_of(0), fleet, 0x0102, 4, session), key);
  EXPECT_NE(session_key(key_of(0), fleet, 0x0102, 3, {}), key);
}

}  // namespace
}  // namespace fleetmap::trust
