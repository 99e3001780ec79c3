#include "fleetmap/output/csv_line.hpp"

#include <gtest/gtest.h>

namespace fleetmap::output {
namespace {

TEST(CsvLine, CellsMayBeEmpty) {
  EXPECT_EQ(csv_cells("a,,1.5"), (std::vector<std::string>{"a", "", "1.5"}));
  EXPECT_EQ(csv_cells(",b"), (std::vector<std::string>{"", "b"}));
  EXPECT_EQ(csv_cells("a,"), (std::vector<std::string>{"a", ""}));
  EXPECT_TRUE(csv_cells("").empty());
}

}  // namespace
}  // namespace fleetmap::output
