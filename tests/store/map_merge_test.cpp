#include "fleetmap/store/map_merge.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::kA;
using testing::kB;

cloud::PointCloud bare_cloud(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-8.0f, 8.0f);
  cloud::PointCloud cloud;
  for (int k = 0; k < 3000; ++k)
    cloud.points.emplace_back(uniform(random), uniform(random), uniform(random) / 8.0f);
  return cloud;
}

Result<cloud::PointCloud> load_bare_cloud(const NodeId& id) {
  return bare_cloud(id.seq + (id.agent == kA ? 0u : 100u));
}

std::map<NodeId, Pose> turned_poses() {
  std::map<NodeId, Pose> T_enu_node;
  for (std::uint32_t seq = 0; seq < 5; ++seq) {
    T_enu_node[{kA, seq}] = se3_exp(Vector6d{4.0 * seq, 0, 0, 0, 0, 0.3 * seq});
    T_enu_node[{kB, seq}] = se3_exp(Vector6d{4.0 * seq, 3.0, 0, 0, 0, -0.2 * seq});
  }
  return T_enu_node;
}

TEST(MapMerge, has_one_point_in_each_voxel_that_any_submap_touches) {
  const MergeConfig config{.voxel_m = 0.5};
  const auto map = merge(turned_poses(), load_bare_cloud, config);
  EXPECT_EQ(map.submaps, 10u);
  EXPECT_EQ(map.points_in, 30'000u);
  const auto voxel = [&](const Eigen::Vector3f& p) {
    return std::array{std::floor(double{p.x()} / 0.5), std::floor(double{p.y()} / 0.5),
                      std::floor(double{p.z()} / 0.5)};
  };
  std::set<std::array<double, 3>> merged;
  for (const auto& point : map.cloud.points) EXPECT_TRUE(merged.insert(voxel(point)).second);
  std::set<std::array<double, 3>> touched;
  for (const auto& [id, T_enu] : turned_poses()) {
    for (const auto& point : cloud::transformed(*load_bare_cloud(id), T_enu).points)
      touched.insert(voxel(point));
  }
  EXPECT_EQ(merged, touched);
}

TEST(MapMerge, is_the_same_for_every_agent_and_stable_when_submaps_come) {
  const MergeConfig config{.voxel_m = 0.3};
  const auto once = merge(turned_poses(), load_bare_cloud, config);
  const auto again = merge(turned_poses(), load_bare_cloud, config);
  ASSERT_EQ(once.cloud.size(), again.cloud.size());
  EXPECT_EQ(std::memcmp(once.cloud.points.data(), again.cloud.points.data(), once.cloud.size() * 12), 0);
  // A node that sorts last only appends.
  auto more_poses = turned_poses();
  more_poses[{kB, 9}] = Pose::Identity();
  const auto more = merge(more_poses, load_bare_cloud, config);
  ASSERT_GT(more.cloud.size(), once.cloud.size());
  EXPECT_EQ(std::memcmp(once.cloud.points.data(), more.cloud.points.data(), once.cloud.size() * 12), 0);
}

TEST(MapMerge, tells_which_agent_saw_a_voxel_first) {
  const MergeConfig config{.voxel_m = 0.5};
  const auto map = merge(turned_poses(), load_bare_cloud, config);
  ASSERT_EQ(map.observed_by.size(), map.cloud.size());
  EXPECT_EQ(map.agents, (std::vector<AgentId>{kA, kB}));
  auto of_a_alone = turned_poses();
  std::erase_if(of_a_alone, [](const auto& entry) { return entry.first.agent != kA; });
  const auto alone = merge(of_a_alone, load_bare_cloud, config);
  for (std::size_t i = 0; i < map.cloud.size(); ++i)
    EXPECT_EQ(map.observed_by[i], i < alone.cloud.size() ? 0 : 1);
}

TEST(MapMerge, finds_the_greatest_intensity_that_is_a_number) {
  const auto bright = [](const NodeId& id) -> Result<cloud::PointCloud> {
    auto cloud = load_bare_cloud(id).value();
    cloud.intensities.assign(cloud.size(), 3.0f);
    cloud.intensities[4] = 17.0f + static_cast<float>(id.seq);
    cloud.intensities[5] = std::numeric_limits<float>::quiet_NaN();
    cloud.intensities[6] = std::numeric_limits<float>::infinity();
    return cloud;
  };
  EXPECT_EQ(merge(turned_poses(), bright, {}).max_intensity, 21.0f);
  EXPECT_EQ(merge(turned_poses(), load_bare_cloud, {}).max_intensity, 0.0f);
}

TEST(MapMerge, leaves_out_and_names_what_it_cannot_read) {
  const auto broken = [](const NodeId& id) -> Result<cloud::PointCloud> {
    if (id == NodeId{kA, 2}) return failure("damaged");
    auto cloud = load_bare_cloud(id).value();
    cloud.points[0].x() = std::numeric_limits<float>::quiet_NaN();
    return cloud;
  };
  const auto map = merge(turned_poses(), broken, {});
  EXPECT_EQ(map.submaps, 9u);
  EXPECT_EQ(map.unreadable, (std::vector<NodeId>{{kA, 2}}));
  EXPECT_EQ(map.points_refused, 9u);
  EXPECT_TRUE(merge({}, load_bare_cloud, {}).cloud.empty());
  EXPECT_FALSE(MergeConfig{.voxel_m = 0.0}.validate());
}

}  // namespace
}  // namespace fleetmap::store
