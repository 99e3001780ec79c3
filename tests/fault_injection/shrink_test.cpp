#include "shrink.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace fleetmap::fault_injection {
namespace {

using Subset = std::vector<std::size_t>;

bool has(const Subset& subset, std::size_t element) { return std::ranges::count(subset, element) > 0; }

TEST(Shrink, finds_the_elements_that_fail_together) {
  const auto kept = shrink(20, [](const Subset& s) { return has(s, 3) && has(s, 17); });
  EXPECT_EQ(kept, (Subset{3, 17}));
}

TEST(Shrink, keeps_one_of_those_that_fail_alone) {
  const auto kept = shrink(9, [](const Subset& s) { return has(s, 2) || has(s, 7); });
  EXPECT_EQ(kept.size(), 1u);
}

TEST(Shrink, keeps_nothing_where_nothing_is_needed_and_all_where_all_are) {
  EXPECT_TRUE(shrink(5, [](const Subset&) { return true; }).empty());
  EXPECT_EQ(shrink(5, [](const Subset& s) { return s.size() == 5; }).size(), 5u);
}

}  // namespace
}  // namespace fleetmap::fault_injection
