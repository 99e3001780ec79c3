#include "monitor/foxglove/thinned_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "monitor/foxglove/read_cloud.hpp"
#include "monitor/views.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using ::testing::ElementsAre;
using testing::node_id;
using testing::read_cloud;
using testing::ViewMaker;

/// Submaps whose k-th point lies (0, k, seq) in the node's frame; their sizes by the node's number.
class Submaps {
 public:
  explicit Submaps(std::vector<std::size_t> sizes) : sizes_(std::move(sizes)) {}
  ThinnedMap::Load load() {
    return [this](const graph::Node& node) -> Result<ThinnedMap::Cloud> {
      loaded.push_back(node.id);
      if (sizes_[node.id.seq] == kUnreadable) return failure("disk error");
      QuantisedCloud cloud;
      cloud.whole = sizes_[node.id.seq];
      for (std::size_t k = 0; k < sizes_[node.id.seq]; ++k) {
        for (const std::size_t value : {std::size_t{0}, k, std::size_t{node.id.seq}, std::size_t{1000}})
          cloud.values.push_back(static_cast<std::int16_t>(value));
      }
      return std::make_shared<const QuantisedCloud>(cloud);
    };
  }
  static constexpr std::size_t kUnreadable = 99'999;
  std::vector<NodeId> loaded;

 private:
  std::vector<std::size_t> sizes_;
};

std::shared_ptr<const FleetView> view_of_nodes(int nodes) {
  ViewMaker fleet;
  fleet.robot("r1", 0.0, nodes);
  return std::make_shared<const FleetView>(fleet.view);
}

std::size_t steps(ThinnedMap& map) {
  std::size_t count = 1;
  while (map.step()) ++count;
  return count;
}

TEST(ThinnedMap, places_all_points_of_a_small_map) {
  Submaps submaps({3, 2});
  ThinnedMap map(100, submaps.load());
  ViewMaker fleet;
  fleet.robot("r2", 50.0, 2).robot("r1", 0.0, 1);
  fleet.view.placement.T_enu_node[node_id("r1", 0)] =
      make_pose(rotation_from_rpy(0.0, 0.0, std::numbers::pi / 2.0), {10.0, 20.0, 30.0});
  map.begin(std::make_shared<const FleetView>(fleet.view));
  EXPECT_EQ(steps(map), 3u) << "one submap each";
  const auto points = read_cloud(map.message());
  ASSERT_EQ(points.size(), 8u);
  EXPECT_NEAR(points[2].p[0], 10.0f - 2.0f, 1e-5f) << "turned by a quarter";
  EXPECT_NEAR(points[2].p[1], 20.0f, 1e-5f);
  EXPECT_NEAR(points[2].p[2], 30.0f, 1e-5f);
  EXPECT_EQ(points[2].intensity, 1000);
  EXPECT_EQ(points[2].robot, 0);
  EXPECT_EQ(points[7].p, (std::array<float, 3>{54.0f, 1.0f, 1.0f}));
  EXPECT_EQ(points[7].robot, 1);
}

TEST(ThinnedMap, small_submaps_leave_their_points_to_the_others) {
  Submaps submaps({2, 100, 100});
  ThinnedMap map(30, submaps.load());
  map.begin(view_of_nodes(3));
  steps(map);
  const auto points = read_cloud(map.message());
  ASSERT_EQ(points.size(), 30u);
  const auto of = [&](float seq) {
    return std::ranges::count_if(points, [&](const auto& point) { return point.p[2] == seq; });
  };
  EXPECT_EQ(of(0.0f), 2);
  EXPECT_EQ(of(1.0f), 14);
  EXPECT_EQ(of(2.0f), 14);
}

TEST(ThinnedMap, a_newer_view_loads_what_is_new_alone) {
  Submaps submaps({50, 50, 50, 50});
  ThinnedMap map(60, submaps.load());
  map.begin(view_of_nodes(2));
  steps(map);
  submaps.loaded.clear();
  map.begin(view_of_nodes(4));
  EXPECT_EQ(steps(map), 2u);
  EXPECT_THAT(submaps.loaded, ElementsAre(node_id("r1", 2), node_id("r1", 3)));
  EXPECT_EQ(read_cloud(map.message()).size(), 60u);
  submaps.loaded.clear();
  map.begin(view_of_nodes(1));  // more points of fewer submaps
  steps(map);
  EXPECT_THAT(submaps.loaded, ElementsAre(node_id("r1", 0)));
  EXPECT_EQ(read_cloud(map.message()).size(), 50u);
}

TEST(ThinnedMap, submaps_that_are_not_held_not_placed_or_not_readable_are_left_out) {
  Submaps submaps({5, Submaps::kUnreadable, 5, 5});
  ThinnedMap map(100, submaps.load());
  ViewMaker fleet;
  fleet.robot("r1", 0.0, 4);
  fleet.view.has_submap[2] = false;
  fleet.view.placement.T_enu_node.erase(node_id("r1", 3));
  map.begin(std::make_shared<const FleetView>(fleet.view));
  steps(map);
  EXPECT_EQ(read_cloud(map.message()).size(), 5u);
  EXPECT_THAT(map.unreadable(), ElementsAre(node_id("r1", 1)));
}

TEST(ThinnedMap, without_a_view_it_is_empty) {
  ThinnedMap map(100, {});
  EXPECT_FALSE(map.step());
  EXPECT_TRUE(read_cloud(map.message()).empty());
}

TEST(ThinnedMap, more_submaps_than_points_stay_within_the_points) {
  Submaps submaps(std::vector<std::size_t>(50, 10));
  ThinnedMap map(20, submaps.load());
  map.begin(view_of_nodes(50));
  steps(map);
  EXPECT_EQ(read_cloud(map.message()).size(), 20u);
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
