#include "fleetmap/sim/ground_truth.hpp"

#include <gtest/gtest.h>

#include "shapes.hpp"

namespace fleetmap::sim {
namespace {

TEST(GroundTruth, LeavesOutOnlyWhatIsBelowTheGround) {
  Mesh mesh = test_ground({-10, -10}, {10, 10}, [](double x, double) { return 0.2 * x; });
  const double ground_area = area(mesh);
  append(mesh, test_box({-3.1, -8, -4}, {-3, 8, 1.4}));  // a wall, mostly below
  const auto world = World::create(std::move(mesh));
  ASSERT_TRUE(world.has_value()) << world.error().message;
  const auto truth = ground_truth(**world, 100.0, 4);
  std::size_t wall = 0;
  for (const auto& p : truth.points) {
    const double z = static_cast<double>(p.z()), ground = 0.2 * static_cast<double>(p.x());
    EXPECT_GT(z, ground - 0.15);
    wall += z > ground + 0.05 ? 1 : 0;
  }
  // Two sides of 16 m x 2 m, and the narrow ones.
  EXPECT_NEAR(static_cast<double>(wall), 6600.0, 300.0);
  EXPECT_NEAR(static_cast<double>(truth.size() - wall), 100.0 * ground_area, 600.0);
}

}  // namespace
}  // namespace fleetmap::sim
