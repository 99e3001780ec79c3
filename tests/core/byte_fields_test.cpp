#include "fleetmap/core/byte_fields.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(ByteFields, TakesLittleEndianNumbersAndCountedText) {
  const Bytes bytes{0x34, 0x12, 3, 0, 0, 0, 'a', 'b', 'c', 1, 2, 3, 4, 5, 6, 7, 0x80, 9};
  ByteFields fields(bytes);
  EXPECT_EQ(fields.number<std::uint16_t>(), 0x1234);
  EXPECT_EQ(fields.text(), "abc");
  EXPECT_EQ(fields.number<std::uint64_t>(), 0x8007060504030201u);
  EXPECT_TRUE(fields.whole());
  EXPECT_EQ(fields.rest().size(), 1u);
}

TEST(ByteFields, AfterTheEndAllIsZeroAndItSaysSo) {
  const Bytes bytes{255, 255, 255, 255, 1};
  ByteFields fields(bytes);
  EXPECT_EQ(fields.text(), "") << "claims more than there is";
  EXPECT_FALSE(fields.whole());
  EXPECT_EQ(fields.number<std::uint8_t>(), 0);
  EXPECT_TRUE(fields.rest().empty());
}

}  // namespace
}  // namespace fleetmap
