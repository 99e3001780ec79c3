#include "fleetmap/core/text_list.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(TextList, SeparatorsStandBetweenItemsAlone) {
  std::string list;
  append_to_list(list, "r1");
  EXPECT_EQ(list, "r1");
  append_to_list(list, std::string("r2"));
  append_to_list(list, "r3", " or ");
  EXPECT_EQ(list, "r1, r2 or r3");
}

}  // namespace
}  // namespace fleetmap
