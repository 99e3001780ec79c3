#include "fleetmap/core/bytes.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(ContentHash, IsTheHeadOfSha256) {
  EXPECT_EQ(to_hex(content_hash({})), "e3b0c44298fc1c149afbf4c8996fb924");
  const Bytes abc{'a', 'b', 'c'};
  EXPECT_EQ(to_hex(content_hash(abc)), "ba7816bf8f01cfea414140de5dae2223");
}

TEST(ContentHash, EveryBitCounts) {
  Bytes bytes(100, 0x5a);
  const ContentHash before = content_hash(bytes);
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    bytes[k] ^= 1;
    EXPECT_NE(content_hash(bytes), before);
    bytes[k] ^= 1;
  }
}

}  // namespace
}  // namespace fleetmap
