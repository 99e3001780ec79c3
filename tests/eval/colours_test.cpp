#include "fleetmap/eval/colours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

namespace fleetmap::eval {
namespace {

TEST(Colours, of_tables_are_where_they_belong_and_of_robots_differ) {
  // The polynomials are fits.
  const auto near = [](Rgb a, Rgb b) {
    return std::abs(a.r - b.r) < 25 && std::abs(a.g - b.g) < 25 && std::abs(a.b - b.b) < 25;
  };
  EXPECT_TRUE(near(viridis(0.0), {68, 1, 84}));
  EXPECT_TRUE(near(viridis(0.5), {33, 145, 140}));
  EXPECT_TRUE(near(viridis(1.0), {253, 231, 37}));
  EXPECT_TRUE(near(turbo(0.5), {164, 252, 60}));
  EXPECT_EQ(viridis(7.0), viridis(1.0));
  EXPECT_EQ(turbo(NAN), (Rgb{128, 128, 128}));
  std::set<std::string> robots;
  for (std::size_t k = 0; k < 7; ++k) robots.insert(hex(robot_colour(k)));
  EXPECT_EQ(robots.size(), 7u);
  EXPECT_EQ(hex({1, 171, 255}), "#01abff");
}

}  // namespace
}  // namespace fleetmap::eval
