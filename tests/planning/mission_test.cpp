#include "fleetmap/planning/mission.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace fleetmap::planning {
namespace {

std::vector<Lane> lanes(std::size_t count, double length, double pitch) {
  std::vector<Lane> all;
  for (std::size_t k = 0; k < count; ++k) {
    const double north = pitch * static_cast<double>(k);
    all.push_back({{0.0, north}, {length, north}});
  }
  return all;
}

TEST(MissionOfAisles, PiecesOfCutLanesFollowEachOtherAsOnePath) {
  // Lanes 0, 2 and 4, each in five pieces of 10 m.
  const Mission mission = mission_of_aisles(lanes(5, 50.0, 4.0), {2, 12.0}, {}, std::nullopt);
  ASSERT_EQ(mission.rows.size(), 15u);
  for (std::size_t k = 0; k < mission.rows.size(); ++k) {
    EXPECT_EQ(mission.rows[k].id, k);
    EXPECT_NEAR(length_of(mission.rows[k].waypoints), 10.0, 1e-9);
    if (k == 0) continue;
    const Eigen::Vector2d gap = mission.rows[k].waypoints.front() - mission.rows[k - 1].waypoints.back();
    EXPECT_NEAR(gap.norm(), k % 5 == 0 ? 8.0 : 0.0, 1e-9) << k;  // to the next lane that is driven
  }
}

TEST(MissionOfAisles, WholeLanesKeepTheirDirection) {
  const Mission mission = mission_of_aisles(lanes(3, 50.0, 4.0), {1, 0.0}, {}, std::nullopt);
  ASSERT_EQ(mission.rows.size(), 3u);
  for (const Row& row : mission.rows) EXPECT_EQ(row.waypoints.front().x(), 0.0);
}

}  // namespace
}  // namespace fleetmap::planning
