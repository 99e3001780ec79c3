#include "site/point_text.hpp"

#include <gtest/gtest.h>

namespace fleetmap::planning {
namespace {

TEST(PointText, IsInDecimetresEastBeforeNorth) {
  EXPECT_EQ(point_text({12.34, -4.56}), "(12.3, -4.6)");
  EXPECT_EQ(point_text({1e6, 0.0}), "(1000000.0, 0.0)");
}

}  // namespace
}  // namespace fleetmap::planning
