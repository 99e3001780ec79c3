#include "recording/pack.hpp"

#include <gtest/gtest.h>

#include "recording/unpack.hpp"

namespace fleetmap::recording {
namespace {

TEST(Pack, WhatIsPackedIsUnpackedAgain) {
  Bytes text(700'000);
  for (std::size_t k = 0; k < text.size(); ++k) text[k] = static_cast<std::uint8_t>(k % 1000 / 7);
  for (const Bytes& bytes : {Bytes{}, Bytes{1}, text}) {
    const auto zstd = pack_zstd(bytes), lz4 = pack_lz4(bytes);
    ASSERT_TRUE(zstd && lz4);
    EXPECT_TRUE(is_zstd(*zstd));
    EXPECT_EQ(unpack_zstd(*zstd, bytes.size()), bytes);
    EXPECT_EQ(unpack_lz4(*lz4, bytes.size()), bytes);
  }
  EXPECT_LT(pack_zstd(text)->size(), text.size() / 20);
  EXPECT_LT(pack_lz4(text)->size(), text.size() / 20);
}

}  // namespace
}  // namespace fleetmap::recording
