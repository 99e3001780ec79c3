#include "fleetmap/output/lidar_mount.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

TEST(LidarMount, IsReadAsItWasStored) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "store.db";
  {
    auto store = store::Store::open(file, AgentId::parse("r1").value()).value();
    EXPECT_FALSE(lidar_mount(store)) << "of an older program";
    ASSERT_TRUE(keep_lidar_mount(store, {0.1, -0.2, 0.6}));
  }
  EXPECT_EQ(lidar_mount(store::Store::open_read_only(file).value()), Eigen::Vector3d(0.1, -0.2, 0.6));
  auto store = store::Store::open(file, AgentId::parse("r1").value()).value();
  ASSERT_TRUE(keep_lidar_mount(store, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(lidar_mount(store));
}

}  // namespace
}  // namespace fleetmap::output
