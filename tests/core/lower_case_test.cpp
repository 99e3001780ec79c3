#include "fleetmap/core/lower_case.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(LowerCase, ChangesLettersOfAsciiAlone) {
  EXPECT_EQ(lower_case("EPSG:32630"), "epsg:32630");
  EXPECT_EQ(lower_case(".Ply"), ".ply");
  EXPECT_EQ(lower_case(""), "");
  EXPECT_EQ(lower_case("\xc3\x84"), "\xc3\x84");
}

}  // namespace
}  // namespace fleetmap
