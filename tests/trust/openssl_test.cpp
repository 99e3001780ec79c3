#include "openssl.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "fleetmap/trust/signing_key.hpp"

namespace fleetmap::trust {
namespace {

TEST(OpenSsl, AFailureNamesWhatFailed) {
  EXPECT_NO_THROW(require(true, "a hash"));
  try {
    require(false, "a hash");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "OpenSSL: a hash failed");
  }
}

TEST(OpenSsl, RandomBytesFillTheWholeSpanAndDiffer) {
  std::array<std::uint8_t, 64> one{}, other{};
  fill_random(one);
  fill_random(other);
  EXPECT_NE(one, other);
  for (const auto& bytes : {one, other}) {
    // 16 zeros in a row are as likely as a guessed key.
    EXPECT_TRUE(std::any_of(bytes.begin(), bytes.begin() + 16, [](auto b) { return b != 0; }));
    EXPECT_TRUE(std::any_of(bytes.end() - 16, bytes.end(), [](auto b) { return b != 0; }));
  }
}

TEST(OpenSsl, APublicKeyKeepsItsBytes) {
  const auto key = SigningKey::generate().public_key();
  const KeyHandle handle = public_key_handle(key);
  ASSERT_NE(handle, nullptr);
  std::array<std::uint8_t, 32> raw{};
  std::size_t size = raw.size();
  ASSERT_EQ(EVP_PKEY_get_raw_public_key(handle.get(), raw.data(), &size), 1);
  EXPECT_EQ(size, raw.size());
  EXPECT_TRUE(std::ranges::equal(raw, key));
}

}  // namespace
}  // namespace fleetmap::trust
