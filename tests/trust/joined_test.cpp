#include "joined.hpp"

#include <gtest/gtest.h>

namespace fleetmap::trust {
namespace {

TEST(Joined, PartsFollowEachOtherInTheirOrder) {
  const Bytes first{1, 2}, second{3};
  EXPECT_EQ(joined({first, second, first}), (Bytes{1, 2, 3, 1, 2}));
  EXPECT_EQ(joined({{}, second, {}}), second);
  EXPECT_EQ(joined({}), Bytes());
  EXPECT_EQ(joined({ByteView(), ByteView()}), Bytes());
}

TEST(Joined, ATextIsItsCharacters) {
  EXPECT_EQ(joined({bytes_of("ab"), bytes_of(""), bytes_of("\xff")}), (Bytes{'a', 'b', 0xff}));
}

}  // namespace
}  // namespace fleetmap::trust
