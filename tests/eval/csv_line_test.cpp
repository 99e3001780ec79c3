#include "fleetmap/eval/csv_line.hpp"

#include <gtest/gtest.h>

namespace fleetmap::eval {
namespace {

TEST(CsvLine, CellsMayBeEmpty) {
  EXPECT_EQ(cells_of("a,,1.5"), (std::vector<std::string>{"a", "", "1.5"}));
  EXPECT_EQ(cells_of(",b"), (std::vector<std::string>{"", "b"}));
  EXPECT_TRUE(cells_of("").empty());
}

}  // namespace
}  // namespace fleetmap::eval
